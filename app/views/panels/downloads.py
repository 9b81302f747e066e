"""What a visitor takes along: the link, a picture, the maps, the orbits, and the lines of Python that make them again."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial
from io import BytesIO

import panel as pn
import panel_material_ui as pmui

from app.exports import file_stem, netcdf_bytes, orbits_csv, png_bytes, python_lines
from app.job_clients.orbit_requests import ChosenOrbit
from app.rendering.map_analyses import MapAnalyses
from app.rendering.map_images import ON_DEMAND, TITLES
from app.state.view_state import ViewState
from app.views.components.flex_row import flex_row
from engine import EscapeMap

SIDES = {"300 pixels": 300, "600 pixels": 600, "1200 pixels": 1200}
"""Sides of each map in a picture to take along."""

_NOTHING = "The map is not whole yet."


class Downloads:
    """Buttons that make their files when they are pressed."""

    def __init__(self, state: ViewState, copy_link: Callable[[], None]) -> None:
        self._state = state
        self._frame: EscapeMap | None = None
        self._findings = MapAnalyses()
        self._orbits: Sequence[ChosenOrbit] = ()
        self.link = pmui.Button(label="Copy the link", variant="outlined", size="small", sx={"textTransform": "none"})
        self.link.on_click(lambda event: copy_link())
        self.side = pmui.Select(label="Side of each map", options=SIDES, value=600, width=150, size="small")
        self.picture = _download("Picture (PNG)", self._png)
        self.maps = _download("Maps (NetCDF)", self._netcdf)
        self.orbits = _download("Orbits (CSV)", self._csv)
        self.lines = _download("Python lines", self._python)
        self._enable()

    def layout(self) -> pn.viewable.Viewable:
        """The buttons in a row that wraps."""
        title = pn.pane.HTML("<h2 style='font-size:15px;margin:4px 0'>Take it along</h2>", margin=(0, 10))
        row = flex_row(self.link, self.side, self.picture, self.maps, self.orbits, self.lines, gap="8px", align_items="center")
        return pn.Column(title, row, sizing_mode="stretch_width")

    def show_map(self, frame: EscapeMap) -> None:
        """The map to take along, once it is whole."""
        self._frame = frame if frame.complete else None
        self._enable()

    def show_findings(self, findings: MapAnalyses) -> None:
        """What is found out about it."""
        self._findings = findings

    def show_orbits(self, orbits: Sequence[ChosenOrbit]) -> None:
        """The orbits to take along."""
        self._orbits = orbits
        self._enable()

    def _enable(self) -> None:
        for button in (self.picture, self.maps, self.lines):
            button.disabled = self._frame is None
        self.orbits.disabled = not any(one.orbit is not None for one in self._orbits)

    def _named(self, ending: str) -> str:
        return f"{file_stem(self._whole().spec, self._state.case)}{ending}"

    def _whole(self) -> EscapeMap:
        if self._frame is None:
            raise ValueError(_NOTHING)
        return self._frame

    def _png(self) -> Callable[[], bytes]:
        self.picture.filename = self._named(".png")
        there = {"characters": self._findings.regularity, "origins": self._findings.origins}
        pictures = [name for name in TITLES if name != "curves" and (name not in ON_DEMAND or there[name] is not None)]
        starts = tuple(one.start for one in self._orbits)
        return partial(
            png_bytes, self._whole(), pictures, self._state.colours, self.side.value, findings=self._findings, starts=starts
        )

    def _netcdf(self) -> Callable[[], bytes]:
        self.maps.filename = self._named(".nc")
        return partial(netcdf_bytes, self._whole(), self._findings)

    def _csv(self) -> Callable[[], bytes]:
        self.orbits.filename = "orbits.csv" if self._frame is None else self._named("-orbits.csv")
        chosen = [one.orbit for one in self._orbits if one.orbit is not None]
        return lambda: orbits_csv(chosen).encode()

    def _python(self) -> Callable[[], bytes]:
        self.lines.filename = self._named(".py")
        specs = [self._state.orbit_spec(one.start) for one in self._orbits]
        states = [spec.state for spec in specs if spec is not None]
        lines = python_lines(self._whole().spec, self._state.system, states)
        return lines.encode


def _download(label: str, begin: Callable[[], Callable[[], bytes]]) -> pmui.FileDownload:
    """A button for a file that `begin` names, and that is made beside the loop, which goes on answering everybody."""

    async def make() -> BytesIO:
        return BytesIO(await asyncio.to_thread(begin()))

    return pmui.FileDownload(
        label=label, callback=make, filename="escapes", auto=True, embed=False, variant="outlined", size="small"
    )  # fmt: skip
