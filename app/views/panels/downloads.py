"""Sharing and downloads: the link, figures, the maps, the orbits, and a Python script that computes them again."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial

import panel as pn

from app.browser.components.file_saver import FileSaver
from app.job_clients.orbit_requests import ChosenOrbit
from app.runtime.process_state import process_state
from app.state.view_state import ViewState
from app.views.components.texts import TextPane
from app.views.components.widgets import button
from app.views.panels.embedding import NOT_ALLOWED
from app.views.panels.figure_choices import ShownResults
from app.views.panels.figure_form import FigureForm
from engine import EscapeMap
from engine.results import Sweep
from plots.layers.map_analyses import MapAnalyses
from plots.texts.exports import curves_csv, file_stem, netcdf_bytes, orbits_csv, python_lines

File = tuple[str, Callable[[], bytes]]
"""Name and content of a file; the content is made by a call that may take seconds."""

_NO_MAP = "The map is not complete yet."
_NO_CURVES = "There are no curves against energy yet."


class Downloads:
    """Buttons that make their files when they are pressed."""

    def __init__(
        self,
        state: ViewState,
        copy_link: Callable[[], None],
        copy_embed_code: Callable[[], None],
        on_copied: Callable[[bool], None],
    ) -> None:
        self._state = state
        self._frame: EscapeMap | None = None
        self._analyses = MapAnalyses()
        self._orbits: Sequence[ChosenOrbit] = ()
        self._curves: Sweep | None = None
        self.saver = FileSaver()
        self.link = button("Copy link", copy_link)
        self.embed = button("Copy embed code", copy_embed_code, disabled=not process_state().settings.frame_ancestors)
        self.figure = FigureForm(state, self.saver, self._figure_name, on_copied)
        self.maps = button("Maps (NetCDF)", self._saving(self.netcdf_file))
        self.orbits = button("Orbits (CSV)", self._saving(self.csv_file))
        self.curves = button("Curves (CSV)", self._saving(self.curves_file))
        self.script = button("Python script", self._saving(self.python_file))
        self._enable()

    def build(self) -> list[pn.viewable.Viewable]:
        """The buttons, in a column."""
        hint = TextPane(f"<span class='quiet'>{NOT_ALLOWED}</span>", visible=self.embed.disabled)
        files = [self.maps, self.orbits, self.curves, self.script]
        titles = [TextPane(f"<h3>{title}</h3>", margin=(6, 10, 0, 10)) for title in ("Figure", "Data")]
        return [self.link, self.embed, hint, titles[0], *self.figure.build(), titles[1], *files, self.saver]

    @property
    def escape_map(self) -> EscapeMap | None:
        """The complete map in view; None while it is computed."""
        return self._frame

    @property
    def chosen_orbits(self) -> Sequence[ChosenOrbit]:
        """The orbits in view."""
        return self._orbits

    def show_map(self, frame: EscapeMap) -> None:
        """Set the map to download; files are made of complete maps only."""
        self._frame = frame if frame.complete else None
        self._enable()

    def show_analyses(self, analyses: MapAnalyses) -> None:
        """Set what is known of the map."""
        self._analyses = analyses
        self._enable()

    def show_orbits(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Set the orbits to download."""
        self._orbits = orbits
        self._enable()

    def show_curves(self, curves: Sweep | None) -> None:
        """Set the curves against energy to download; None without any."""
        self._curves = curves
        self._enable()

    async def save(self, file: File) -> None:
        """Make a file in a thread, so that the event loop goes on, and send it to the browser."""
        name, make = file
        self.saver.save(name, await asyncio.to_thread(make))

    def netcdf_file(self) -> File:
        """The map with its analyses."""
        return self._named(".nc"), partial(netcdf_bytes, self._map(), self._analyses)

    def csv_file(self) -> File:
        """The chosen orbits as a table."""
        orbits = [one.orbit for one in self._orbits if one.orbit is not None]
        verdicts = [one.verdict for one in self._orbits if one.verdict is not None]
        name = "orbits.csv" if self._frame is None else self._named("-orbits.csv")
        return name, lambda: orbits_csv(orbits, verdicts=verdicts).encode()

    def curves_file(self) -> File:
        """The curves against energy as a table."""
        if self._curves is None:
            raise ValueError(_NO_CURVES)
        return f"escapes-{self._state.system.case}-curves.csv", partial(_encoded_csv, self._curves)

    def python_file(self) -> File:
        """A script that computes the map and the orbits."""
        jobs = [self._state.orbit_job(one.start) for one in self._orbits]
        states = [job.arguments[1] for job in jobs if job is not None]
        return self._named(".py"), python_lines(self._map().spec, self._state.system, states).encode

    def _saving(self, file: Callable[[], File]) -> Callable[[], None]:
        # `file()` captures the state at the click.
        return lambda: pn.state.execute(partial(self.save, file()))

    def _enable(self) -> None:
        for one in (self.maps, self.script):
            one.disabled = self._frame is None
        self.curves.disabled = self._curves is None
        self.orbits.disabled = not any(one.orbit is not None for one in self._orbits)
        self.figure.show(ShownResults(self._frame, self._analyses, self._orbits, self._curves))

    def _figure_name(self, ending: str) -> str:
        return f"escapes-{self._state.system.case}{ending}" if self._frame is None else self._named(ending)

    def _named(self, ending: str) -> str:
        return f"{file_stem(self._map().spec, self._state.system.case)}{ending}"

    def _map(self) -> EscapeMap:
        if self._frame is None:
            raise ValueError(_NO_MAP)
        return self._frame


def _encoded_csv(curves: Sweep) -> bytes:
    return curves_csv(curves).encode()
