"""The section while the visitor drags the energy, which the browser computes and paints over the chart of the study."""

from __future__ import annotations

import param
from panel.custom import JSComponent

from app.browser.browser_system import slice_name
from app.browser.module_files import LIVE_SECTION_ADDRESS
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.components.widgets import LOADED_MODULE
from engine import Section, System
from plots.studies.section import SECTION_STUDY


class LiveSection(JSComponent):
    """The module on the page, with the slice of the starts and the energy of the chart that the server has sent.

    Parameters
    ----------
    state
        The view state.
    results
        The results of the session, among them the study of the section.
    """

    address = param.String(default=LIVE_SECTION_ADDRESS, doc="address of the module")
    slice = param.Dict(default=None, allow_None=True, doc="the slice of the starts; None if the chart has other axes")
    plane = param.String(doc="name of the slice in the tables of windows")
    energy = param.Number(default=None, allow_None=True, doc="energy of the complete chart of the server; None without one")
    colours = param.List(doc="colours of the orbits")
    duration = param.Number(doc="longest time of the orbits")

    _esm = LOADED_MODULE

    def __init__(self, state: ViewState, results: ShownResults) -> None:
        super().__init__(width=0, height=0, margin=0)
        self._results = results
        state.follow(self._show_slice, "section", "system")
        state.follow(lambda name: self.param.update(colours=list(state.colours.orbits)), "palette")
        state.follow(lambda t_max: self.param.update(duration=t_max), "t_max")
        results.param.watch(lambda event: self._show_energy(), "studies")
        self._show_energy()

    def _show_slice(self, section: Section, system: System) -> None:
        plane = section.slice_of_starts
        columns = section.columns_on(plane)
        described = None if columns is None else plane.to_dict(system.potential.units) | {"sectionColumns": columns}
        self.param.update(slice=described, plane=slice_name(plane))

    def _show_energy(self) -> None:
        found = self._results.studies.get(SECTION_STUDY.name)
        self.energy = found.spec.common_energy if found is not None and found.complete else None
