"""Sharing and downloads: the link, a picture, the maps, the orbits, and a Python script that computes them again."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial

import panel as pn

from app.job_clients.orbit_requests import ChosenOrbit
from app.state.view_state import ViewState
from app.views.components.file_saver import FileSaver
from app.views.components.widgets import button
from engine import EnergyCurves, EscapeMap
from plots.exports import curves_csv, file_stem, netcdf_bytes, orbits_csv, png_bytes, python_lines
from plots.map_analyses import MapAnalyses
from plots.map_images import ON_DEMAND, TITLES

SIDES = {"300 pixels": 300, "600 pixels": 600, "1200 pixels": 1200}
"""Sides of each map in a saved picture."""

File = tuple[str, Callable[[], bytes]]
"""Name and content of a file; the content is made by a call that may take seconds."""

_NO_MAP = "The map is not complete yet."
_NO_CURVES = "There are no curves against energy yet."


class Downloads:
    """Buttons that make their files when they are pressed."""

    def __init__(self, state: ViewState, copy_link: Callable[[], None]) -> None:
        self._state = state
        self._frame: EscapeMap | None = None
        self._analyses = MapAnalyses()
        self._orbits: Sequence[ChosenOrbit] = ()
        self._curves: EnergyCurves | None = None
        self.saver = FileSaver()
        self.link = button("Copy link", copy_link)
        self.side = pn.widgets.Select(label="Side of each map", options=SIDES, value=600, width=130)
        self.picture = button("Picture (PNG)", self._saving(self.png_file))
        self.maps = button("Maps (NetCDF)", self._saving(self.netcdf_file))
        self.orbits = button("Orbits (CSV)", self._saving(self.csv_file))
        self.curves = button("Curves (CSV)", self._saving(self.curves_file))
        self.script = button("Python script", self._saving(self.python_file))
        self._enable()

    def build(self) -> list[pn.viewable.Viewable]:
        """The buttons, in a column."""
        return [self.link, self.side, self.picture, self.maps, self.orbits, self.curves, self.script, self.saver]

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

    def show_orbits(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Set the orbits to download."""
        self._orbits = orbits
        self._enable()

    def show_curves(self, curves: EnergyCurves | None) -> None:
        """Set the curves against energy to download; None without any."""
        self._curves = curves
        self._enable()

    async def save(self, file: File) -> None:
        """Make a file in a thread, so that the event loop goes on, and send it to the browser."""
        name, make = file
        self.saver.save(name, await asyncio.to_thread(make))

    def png_file(self) -> File:
        """All maps in one picture, with their legends."""
        available = {"characters": self._analyses.regularity, "origins": self._analyses.origins}
        pictures = [name for name in TITLES if name != "curves" and (name not in ON_DEMAND or available[name] is not None)]
        starts = tuple(one.start for one in self._orbits)
        make = partial(
            png_bytes,
            self._map(),
            pictures,
            self._state.colours,
            self.side.value,
            analyses=self._analyses,
            starts=starts,
            longest=self._state.lock_times,
        )
        return self._named(".png"), make

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
        return f"escapes-{self._state.case}-curves.csv", partial(_encoded_csv, self._curves)

    def python_file(self) -> File:
        """A script that computes the map and the orbits."""
        jobs = [self._state.orbit_job(one.start) for one in self._orbits]
        states = [job.arguments[1] for job in jobs if job is not None]
        return self._named(".py"), python_lines(self._map().spec, self._state.system, states).encode

    def _saving(self, file: Callable[[], File]) -> Callable[[], None]:
        # `file()` captures the state at the click.
        return lambda: pn.state.execute(partial(self.save, file()))

    def _enable(self) -> None:
        for one in (self.picture, self.maps, self.script):
            one.disabled = self._frame is None
        self.curves.disabled = self._curves is None
        self.orbits.disabled = not any(one.orbit is not None for one in self._orbits)

    def _named(self, ending: str) -> str:
        return f"{file_stem(self._map().spec, self._state.case)}{ending}"

    def _map(self) -> EscapeMap:
        if self._frame is None:
            raise ValueError(_NO_MAP)
        return self._frame


def _encoded_csv(curves: EnergyCurves) -> bytes:
    return curves_csv(curves).encode()
