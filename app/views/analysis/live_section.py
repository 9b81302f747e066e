"""The section while the visitor changes the energy or the window, which the browser computes and paints over the chart."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import param

from app.browser.components.plain_component import PlainComponent
from app.browser.module_files import LIVE_SECTION_ADDRESS
from app.job_clients.latest_request import Locked
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.components.widgets import LOADED_MODULE
from engine import Section, Slice, System
from engine.foundations.validation import LARGEST_NUMBER
from plots.browser.browser_system import slice_name, window_in_browser
from plots.pictures.setting import Settings
from plots.studies.section import CELLS, COLOURS, DENSITIES, RETURNS, SECTION_STUDY, density_colours, start_through
from plots.studies.study import Changes


class LiveSection(PlainComponent):
    """The module on the page, with the slice of the starts, and energy and window of the chart that the server has sent.

    The browser sends {state, energy} of the point that is clicked.

    Parameters
    ----------
    state
        The view state.
    results
        The results of the session, among them the study of the section.
    locked
        Wraps a function to run under the session's lock.
    change
        Changes the view.
    """

    address = param.String(default=LIVE_SECTION_ADDRESS, doc="address of the module")
    slice = param.Dict(default=None, allow_None=True, doc="the slice of the starts; None if the chart has other axes")
    plane = param.String(doc="name of the slice in the tables of windows")
    served = param.Dict(default=None, allow_None=True, doc="energy, window, section of the server's complete chart")
    section = param.String(doc="the section as text")
    follows_window = param.Boolean(doc="whether the window is that of the map")
    returns = param.Integer(default=RETURNS, doc="largest number of returns of an orbit")
    colouring = param.Dict(default={}, doc="the colours, see `Colouring` in the module of dots")
    duration = param.Number(doc="longest time of the orbits")

    _esm = LOADED_MODULE

    def __init__(self, state: ViewState, results: ShownResults, locked: Locked, change: Callable[[Changes], None]) -> None:
        super().__init__(width=0, height=0, margin=0)
        self._state, self._results, self._change = state, results, change
        self._take = locked(self._start_orbit)
        state.follow(self._show_slice, "section", "system")
        state.follow(self._show_window, "plane", "section")
        state.follow(self._show_colours, "palette", "settings")
        state.follow(lambda t_max: self.param.update(duration=t_max), "t_max")
        results.param.watch(lambda event: self._show_served(), "studies")
        self._show_served()

    def _show_slice(self, section: Section, system: System) -> None:
        plane = section.slice_of_starts
        columns = section.columns_on(plane)
        described = None if columns is None else plane.to_dict(system.potential.units) | {"sectionColumns": columns}
        self.param.update(slice=described, plane=slice_name(plane), section=section.text)

    def _show_window(self, plane: Slice, section: Section) -> None:
        self.follows_window = section.is_drawn_on(plane)

    def _show_colours(self, palette: str, settings: Settings) -> None:
        colours = self._state.colours
        self.colouring = {
            "choice": COLOURS.value_in(settings),
            "orbits": list(colours.orbits),
            "inside": colours.bounded,
            "densities": list(DENSITIES),
            "classes": list(density_colours()),
            "cells": CELLS,
        }

    def _show_served(self) -> None:
        found = self._results.studies.get(SECTION_STUDY.name)
        if found is None or not found.complete:
            self.served = None
            return
        window = window_in_browser(found.spec.find_window())
        self.served = {"energy": found.spec.common_energy, "window": window, "section": found.section.text}

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"state": [_, _, _, _] as state, "energy": energy} if all(map(_is_number, [*state, energy])):
                self._take(np.array(state, float), float(energy))

    def _start_orbit(self, start: np.ndarray, energy: float) -> None:
        """Start the orbit of a state, if it is on the section at an energy that the page shows."""
        state, energies = self._state, self._state.energies
        if energy == state.energy or energies.low <= energy <= energies.high:
            self._change(start_through(state.section, state.potential, start, energy))


def _is_number(value: Any) -> bool:
    """Whether a value is a finite number of legal size."""
    return isinstance(value, int | float) and abs(value) <= LARGEST_NUMBER
