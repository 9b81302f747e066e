"""Sharing and downloads: the link, figures, data, and a Python script that computes the view again."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from typing import Any

import panel as pn

from app.browser.components.file_components import FileSaver
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.components.texts import TextPane
from app.views.components.widgets import button
from app.views.panels.embedding import NOT_ALLOWED
from app.views.panels.figure_form import FigureForm
from engine import Result
from plots.live.live_figure import live_figure
from plots.live.live_view import LiveView, live_refusal
from plots.studies.study import Study
from plots.studies.table import STUDIES
from plots.texts.exports import file_stem, netcdf_bytes, orbits_csv, python_lines, section_csv, table_csv

File = tuple[str, Callable[[], bytes]]
"""Name of a file, and the function that makes its content. Calling the function may take seconds."""

LIVE = "Save as live figure"
"""Label of the button that saves a figure which needs no server."""

# Labels of the buttons that save data.
MAPS, ORBITS, CROSSINGS, SCRIPT = "Maps (NetCDF)", "Orbits (CSV)", "Crossings of the orbits (CSV)", "Python script"


class Downloads:
    """Buttons that copy links, and buttons that make files.

    Parameters
    ----------
    state, results
        State and results of the session.
    copy_link, copy_embed_code
        Copy the address of the page, and the HTML of a frame with one picture.
    on_copied
        Handles whether the browser has copied an image.
    may_embed
        Whether other pages may show this page in a frame.
    """

    def __init__(
        self,
        state: ViewState,
        results: ShownResults,
        copy_link: Callable[[], None],
        copy_embed_code: Callable[[], None],
        on_copied: Callable[[bool], None],
        *,
        may_embed: bool,
    ) -> None:
        self._state, self._results = state, results
        self.saver = FileSaver()
        self.link = button("Copy link", copy_link)
        self.embed = button("Copy embed code", copy_embed_code, disabled=not may_embed)
        self.figure = FigureForm(state, results, self.saver, partial(_file_name, results, state), on_copied)
        self.data = {
            label: button(label, partial(self._save, label))
            for label in (LIVE, MAPS, ORBITS, CROSSINGS, *map(_table_label, STUDIES.values()), SCRIPT)
        }
        results.param.watch(lambda *events: self._enable(), ["frame", "orbits", "studies"])
        self._enable()

    def build(self) -> list[pn.viewable.Viewable]:
        """Return the parts of a column: the buttons under their titles."""
        hint = TextPane(f"<span class='quiet'>{NOT_ALLOWED}</span>", visible=self.embed.disabled)
        figure_title, data_title = (TextPane(f"<h3>{title}</h3>", margin=(6, 10, 0, 10)) for title in ("Figure", "Data"))
        live, *data = self.data.values()
        return [self.link, self.embed, hint, figure_title, *self.figure.build(), live, data_title, *data, self.saver]

    async def save(self, file: File) -> None:
        """Make a file in a thread, because making it would delay the event loop, and send the file to the browser."""
        name, make = file
        self.saver.save(name, await asyncio.to_thread(make))

    def _save(self, label: str) -> None:
        file = file_choices(self._results, self._state).get(label)
        if file is not None:
            pn.state.execute(partial(self.save, file))

    def _enable(self) -> None:
        """Enable the buttons whose files the results allow."""
        choices = file_choices(self._results, self._state)
        for label, save_button in self.data.items():
            save_button.disabled = label not in choices


def file_choices(results: ShownResults, state: ViewState) -> dict[str, File]:
    """Return the files of data that the results allow, by label. Later changes of the page do not change the files."""
    choices: dict[str, File] = {}
    name = partial(_file_name, results, state)
    system, frame = state.system, results.whole_map
    if frame is not None:
        # Along a parameter, each orbit belongs to another potential, and the script has no orbits.
        starts = [one.start for one in results.orbits] if state.plane.parameter is None else []
        states = [known for known in map(state.start_state, starts) if known is not None]
        if not live_refusal(frame.spec):
            live_starts = [one.start for one in results.orbits]
            # The map may belong to the view before the last change.
            energy = state.energy if frame.spec.common_energy is None else frame.spec.common_energy
            energies = min(state.energies.low, energy), max(state.energies.high, energy)
            make = partial(live_figure, LiveView(frame.spec, energies, live_starts, palette=state.colours), frame)
            choices[LIVE] = name(".html"), lambda: make().encode()
        choices[MAPS] = name(".nc"), partial(netcdf_bytes, frame, results.analyses)
        script = partial(python_lines, frame.spec, system, states, results.calls.get(state.analysis))
        choices[SCRIPT] = name(".py"), lambda: script().encode()
    orbits = [one.orbit for one in results.orbits if one.orbit is not None]
    if orbits:
        verdicts = [one.verdict for one in results.orbits if one.verdict is not None]
        choices[ORBITS] = name("-orbits.csv"), lambda: orbits_csv(orbits, verdicts=verdicts).encode()
        choices[CROSSINGS] = name("-crossings.csv"), lambda: section_csv(orbits).encode()
    for study_name, found in results.studies.items():
        study = STUDIES[study_name]
        choices[_table_label(study)] = f"escapes-{system.case}-{study.files}.csv", partial(_table_bytes, found)
    return choices


def _table_bytes(found: Result) -> bytes:
    return table_csv(found).encode()


def _table_label(study: Study[Any]) -> str:
    return f"{study.figure} (CSV)"


def _file_name(results: ShownResults, state: ViewState, ending: str) -> str:
    """Return the name of a file about the map, or about the system while the map is computed."""
    frame = results.whole_map
    stem = f"escapes-{state.system.case}" if frame is None else file_stem(frame.spec, state.system.case)
    return f"{stem}{ending}"
