"""The chosen orbits in numbers and words: starts to type, one to look at, its verdict, its twin."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape

import panel as pn
import panel_material_ui as pmui

from app.job_clients.orbit_requests import ChosenOrbit
from app.rendering.palette import PAPER, PATCH_EDGE, Palette
from app.views.components.flex_row import flex_row
from engine import IndicatorVerdict, Orbit, Plane

HINT = "Click a point of any map, or type a start, to see its orbit, its SALI and its R². Up to five are kept."
_NUMBER = "0.[0000000000000000]"
_PLAIN = {"& .MuiToggleButton-root, & .MuiButton-root, & button": {"textTransform": "none"}}


@dataclass(frozen=True)
class OrbitActions:
    """What the desk's buttons do."""

    add: Callable[[float, float], None]
    choose: Callable[[int], None]
    remove: Callable[[], None]
    clear: Callable[[], None]
    find_twin: Callable[[], None]
    open_plane: Callable[[], None]


class OrbitControls:
    """Boxes for a start, the list of orbits, and the verdict on the one that is looked at."""

    def __init__(self, actions: OrbitActions) -> None:
        self._actions = actions
        self._palette = PAPER
        self._told: tuple[tuple[ChosenOrbit, ...], int] = ((), 0)
        self.x = pmui.FloatInput(label="x", value=0.0, step=0.01, format=_NUMBER, width=165, size="small")
        self.ordinate = pmui.FloatInput(label="px", value=0.0, step=0.01, format=_NUMBER, width=165, size="small")
        self.button = pmui.Button(label="Integrate this start", variant="contained", size="small", width=340)
        self.choice = pmui.RadioButtonGroup(label="Orbit", options=[], size="small", visible=False, sx=_PLAIN)
        self.twin = _button("Find its twin", actions.find_twin)
        self.remove = _button("Remove", actions.remove)
        self.clear = _button("Clear all", actions.clear)
        self.open_plane = _button("Open (x, px) at this h", actions.open_plane)
        self.note = pn.pane.HTML("", name="note", sizing_mode="stretch_width")
        self.text = pn.pane.HTML(HINT, name="verdict", sizing_mode="stretch_width")
        self.indicators = pn.pane.HTML("", name="indicators", sizing_mode="stretch_width")
        self.button.on_click(lambda event: self._submit())
        self.choice.param.watch(lambda event: self._choose(event.new), "value")
        self._enable()

    def layout(self, time_bar: pn.viewable.Viewable) -> pn.viewable.Viewable:
        """A column as wide as a picture, with the bar that plays the orbits."""
        title = pn.pane.HTML("<h2 style='font-size:15px;margin:4px 0'>Orbits</h2>")
        starts = pn.Row(self.x, self.ordinate)
        buttons = flex_row(self.twin, self.remove, self.clear, self.open_plane, gap="2px")
        return pn.Column(
            title, starts, self.button, self.choice, buttons, self.note, time_bar, self.text, self.indicators,
            width=370, margin=(0, 6),
        )  # fmt: skip

    def follow_plane(self, plane: Plane) -> None:
        """Name the second box after the plane's ordinate."""
        self.ordinate.label = plane.ordinate
        self.open_plane.visible = plane is Plane.X_H

    def set_palette(self, palette: Palette) -> None:
        """Colours of the orbits' numbers."""
        self._palette = palette
        self.show(*self._told)

    def say(self, sentence: str) -> None:
        """A word on what is going on."""
        self.note.object = f"<p style='margin:4px 0'>{escape(sentence)}</p>"

    def show_indicators(self, verdicts: Sequence[IndicatorVerdict]) -> None:
        """What each indicator of chaos says of the orbit that is looked at."""
        rows = "".join(
            f"<tr><th scope=row style='text-align:left;vertical-align:top;font-weight:normal;opacity:0.7'>{one.name}"
            f"<br>{_value(one.value)}</th>"
            f"<td><b>{one.conclusion or 'no verdict'}</b><br>{escape(one.sentence)}</td></tr>"
            for one in verdicts
        )
        style = "font-size:13px;border-spacing:8px 3px;margin-left:-8px"
        self.indicators.object = f"<table aria-label='chaos indicators' style='{style}'>{rows}</table>" if rows else ""

    def show(self, orbits: Sequence[ChosenOrbit], chosen: int) -> None:
        """The list, and the verdict on the chosen one with the numbers that it rests on."""
        starts = [one.start for one in orbits], chosen
        if starts != ([one.start for one in self._told[0]], self._told[1]):
            self.note.object = ""
        self._told = (tuple(orbits), chosen)
        numbers = [str(place + 1) for place in range(len(orbits))]
        self.choice.param.update(options=numbers, value=numbers[chosen] if orbits else None, visible=len(orbits) > 1)
        self._enable()
        if not orbits:
            self.note.object, self.text.object = "", HINT
            return
        one = orbits[chosen]
        self.x.value, self.ordinate.value = one.start
        self.text.object = f"{self._verdict(one)}{self._table(orbits, chosen)}{_numbers(one.orbit)}"

    def _verdict(self, one: ChosenOrbit) -> str:
        words = one.orbit.describe() if one.orbit is not None else one.problem or "Integrating …"
        return f"<p style='margin:6px 0'><b>{escape(words)}</b></p>"

    def _table(self, orbits: Sequence[ChosenOrbit], chosen: int) -> str:
        if len(orbits) < 2:
            return ""
        rows = "".join(
            f"<tr{' aria-current=true style=font-weight:bold' if place == chosen else ''}><td>{self._patch(place)}</td>"
            f"<td style='padding-right:10px'>{one.start[0]:.6g}, {one.start[1]:.6g}</td><td>{_fate(one)}</td></tr>"
            for place, one in enumerate(orbits)
        )
        return f"<table aria-label='the chosen orbits' style='font-size:13px'>{rows}</table>"

    def _patch(self, place: int) -> str:
        style = f"background:{self._palette.orbits[place]};border:1px solid {PATCH_EDGE};color:#ffffff;padding:0 5px"
        return f"<span style='{style};text-shadow:0 0 2px #000000'>{place + 1}</span>"

    def _enable(self) -> None:
        nothing = not self._told[0]
        for button in (self.twin, self.remove, self.clear, self.open_plane):
            button.disabled = nothing

    def _choose(self, number: str | None) -> None:
        if number is not None and int(number) - 1 != self._told[1]:
            self._actions.choose(int(number) - 1)

    def _submit(self) -> None:
        if self.x.value is None or self.ordinate.value is None:
            self.say("Type a number into both boxes first.")
            return
        self._actions.add(self.x.value, self.ordinate.value)


def _value(value: float) -> str:
    return f"{value:.3g}" if math.isfinite(value) else ""


def _fate(one: ChosenOrbit) -> str:
    if one.orbit is None:
        return "none" if one.problem else "…"
    if one.orbit.fate >= 1:
        return f"channel {one.orbit.fate} at t = {one.orbit.escape_time:.5g}"
    return f"bounded, {one.orbit.regularity}" if one.orbit.regularity is not None else "outside"


def _numbers(orbit: Orbit | None) -> str:
    if orbit is None:
        return ""
    rows = {
        "energy h": f"{orbit.energy:.10g}",
        "start x, y": f"{orbit.x[0]:.6g}, {orbit.y[0]:.6g}",
        "start px, py": f"{orbit.px[0]:.6g}, {orbit.py[0]:.6g}",
        "upward crossings of y = 0": f"{orbit.crossings}",
        "last SALI": f"{orbit.sali[-1]:.3g}",
        "relative energy error": f"{orbit.energy_error:.1e}",
    }
    cells = "".join(
        f"<tr><td style='padding-right:12px;opacity:0.7'>{name}</td><td>{value}</td></tr>" for name, value in rows.items()
    )
    return f"<table aria-label='the orbit in numbers' style='font-size:13px'>{cells}</table>"


def _button(label: str, press: Callable[[], None]) -> pmui.Button:
    button = pmui.Button(label=label, variant="outlined", size="small", sx={"textTransform": "none"})
    button.on_click(lambda event: press())
    return button
