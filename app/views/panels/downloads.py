"""Sharing and downloads: the link, figures, data, and a Python script that computes maps and orbits again."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial

import panel as pn

from app.browser.components.file_components import FileSaver
from app.job_clients.shown_results import ShownResults
from app.runtime.process_state import process_state
from app.state.view_state import ViewState
from app.views.components.texts import TextPane
from app.views.components.widgets import button
from app.views.panels.embedding import NOT_ALLOWED
from app.views.panels.figure_form import FigureForm
from engine import EscapeMap
from plots.texts.exports import curves_csv, file_stem, netcdf_bytes, orbits_csv, python_lines

File = tuple[str, Callable[[], bytes]]
"""Name of a file, and the function that makes its content. Calling the function may take seconds."""

_NO_MAP = "The map is not complete yet."
_NO_CURVES = "There are no curves against energy yet."


class Downloads:
    """Buttons that copy links, and buttons that make files."""

    def __init__(
        self,
        state: ViewState,
        results: ShownResults,
        copy_link: Callable[[], None],
        copy_embed_code: Callable[[], None],
        on_copied: Callable[[bool], None],
    ) -> None:
        self._state, self._results = state, results
        self.saver = FileSaver()
        self.link = button("Copy link", copy_link)
        self.embed = button("Copy embed code", copy_embed_code, disabled=not process_state().settings.frame_ancestors)
        self.figure = FigureForm(state, results, self.saver, self._figure_name, on_copied)
        self.maps = button("Maps (NetCDF)", self._save_on_click(self.netcdf_file))
        self.orbits = button("Orbits (CSV)", self._save_on_click(self.csv_file))
        self.curves = button("Curves (CSV)", self._save_on_click(self.curves_file))
        self.script = button("Python script", self._save_on_click(self.python_file))
        results.param.watch(lambda *events: self._enable(), ["frame", "orbits", "curves"])
        self._enable()

    def build(self) -> list[pn.viewable.Viewable]:
        """Return the parts of a column: the buttons under their titles."""
        hint = TextPane(f"<span class='quiet'>{NOT_ALLOWED}</span>", visible=self.embed.disabled)
        files = [self.maps, self.orbits, self.curves, self.script]
        titles = [TextPane(f"<h3>{title}</h3>", margin=(6, 10, 0, 10)) for title in ("Figure", "Data")]
        return [self.link, self.embed, hint, titles[0], *self.figure.build(), titles[1], *files, self.saver]

    async def save(self, file: File) -> None:
        """Make a file in a thread, because making it would delay the event loop, and send the file to the browser."""
        name, make = file
        self.saver.save(name, await asyncio.to_thread(make))

    def netcdf_file(self) -> File:
        """Return the file of the map with its analyses."""
        return self._file_name(".nc"), partial(netcdf_bytes, self._map(), self._results.analyses)

    def csv_file(self) -> File:
        """Return the file with a table of the orbits."""
        orbits = [one.orbit for one in self._results.orbits if one.orbit is not None]
        verdicts = [one.verdict for one in self._results.orbits if one.verdict is not None]
        name = "orbits.csv" if self._results.whole_map is None else self._file_name("-orbits.csv")
        return name, lambda: orbits_csv(orbits, verdicts=verdicts).encode()

    def curves_file(self) -> File:
        """Return the file with a table of the curves against energy or a parameter."""
        curves = self._results.curves
        if curves is None:
            raise ValueError(_NO_CURVES)
        return f"escapes-{self._state.system.case}-curves.csv", lambda: curves_csv(curves).encode()

    def python_file(self) -> File:
        """Return the script that computes the map and the orbits."""
        jobs = [self._state.orbit_job(one.start) for one in self._results.orbits]
        states = [job.arguments[1] for job in jobs if job is not None]
        return self._file_name(".py"), python_lines(self._map().spec, self._state.system, states).encode

    def _save_on_click(self, file: Callable[[], File]) -> Callable[[], None]:
        # `file()` uses the results at the time of the click.
        return lambda: pn.state.execute(partial(self.save, file()))

    def _enable(self) -> None:
        for map_button in (self.maps, self.script):
            map_button.disabled = self._results.whole_map is None
        self.curves.disabled = self._results.curves is None
        self.orbits.disabled = not any(one.orbit is not None for one in self._results.orbits)

    def _figure_name(self, ending: str) -> str:
        return f"escapes-{self._state.system.case}{ending}" if self._results.whole_map is None else self._file_name(ending)

    def _file_name(self, ending: str) -> str:
        return f"{file_stem(self._map().spec, self._state.system.case)}{ending}"

    def _map(self) -> EscapeMap:
        frame = self._results.whole_map
        if frame is None:
            raise ValueError(_NO_MAP)
        return frame
