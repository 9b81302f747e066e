"""Controls of the orbits: starts to type, the list of orbits, and the values and verdicts of the chosen one."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape

import panel as pn

from app.job_clients.orbit_requests import ChosenOrbit
from app.views.components.collapsible_section import Fold
from app.views.components.flex_row import FULL_HEIGHT, flex_row
from app.views.components.numbers import grouped
from app.views.components.widgets import OrbitList, button
from engine import Orbit, Plane
from engine.service import IndicatorVerdict
from plots.palette import Palette

HINT = "Click a map to see the orbit of the pixel, its SALI and R²; up to five orbits."
_BOX = 180
_LONGEST_NUMBER = 40


@dataclass(frozen=True)
class OrbitActions:
    """Callbacks of the buttons."""

    add: Callable[[float, float], None]
    choose: Callable[[int], None]
    remove: Callable[[], None]
    clear: Callable[[], None]
    find_divergent_start: Callable[[], None]
    open_plane: Callable[[], None]
    show_all_times: Callable[[], None]


class OrbitControls:
    """Number boxes for a start, the list of orbits, and what is known of the chosen one."""

    def __init__(self, actions: OrbitActions) -> None:
        self._actions = actions
        self._shown: tuple[tuple[ChosenOrbit, ...], int] = ((), 0)
        # Text boxes, as number boxes do not tell when Enter is pressed.
        self.x = pn.widgets.TextInput(label="x", value="0", max_length=_LONGEST_NUMBER, width=_BOX)
        self.ordinate = pn.widgets.TextInput(label="px", value="0", max_length=_LONGEST_NUMBER, width=_BOX)
        self.button = button("Integrate", self._submit, kind="primary", align="end")
        self.choice = OrbitList(label="Orbits", options=[])
        self.divergent_start = button("Find its twin", actions.find_divergent_start, margin=0)
        self.remove = button("Remove", actions.remove, margin=0)
        self.clear = button("Clear all", actions.clear, margin=0)
        self.open_plane = button("Open (x, px) at this h", actions.open_plane, margin=0)
        self.interval = pn.pane.HTML("", name="interval", margin=(8, 0))
        self._all_times = button("Whole orbit", actions.show_all_times, margin=(4, 8))
        self._interval_row = flex_row(self.interval, self._all_times, align="center")
        self._interval_row.param.update(margin=(0, 10), visible=False)
        self.note = pn.pane.HTML(HINT, name="note", sizing_mode="stretch_width", margin=(0, 10), css_classes=["note"])
        self.text = pn.pane.HTML("", name="verdict", sizing_mode="stretch_width", margin=(0, 10))
        self.values = pn.pane.HTML("", name="values", sizing_mode="stretch_width", margin=(0, 10))
        self.indicators = pn.pane.HTML("", name="indicators", sizing_mode="stretch_width", margin=(0, 10))
        self.choice.param.watch(lambda event: self._choose(event.new), "value")
        for box in (self.x, self.ordinate):
            box.param.watch(lambda event: self._submit(), "enter_pressed")
        self._enable()

    def entry(self) -> list[pn.viewable.Viewable]:
        """The hint or message, and the boxes to type a start."""
        boxes = Fold("Type a start", lambda: [flex_row(self.x, self.ordinate, self.button, align="end")])
        return [self.note, *boxes.parts()]

    def head(self, playback: pn.viewable.Viewable) -> pn.viewable.Viewable:
        """The list of orbits, buttons, the fate of the chosen one in a line, and the player."""
        buttons = flex_row(self.divergent_start, self.remove, self.clear, self.open_plane, gap="6px")
        buttons.margin = (5, 4)
        return pn.Column(
            self.choice, buttons, self.text, playback, self._interval_row,
            sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT,
        )  # fmt: skip

    def details(self) -> pn.viewable.Viewable:
        """The verdicts on the chosen orbit, and its values."""
        return pn.Column(self.indicators, self.values, sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT)

    def follow_plane(self, plane: Plane) -> None:
        """Label the boxes with the axes of the plane."""
        self.x.label, self.ordinate.label = plane.axis_names
        self.open_plane.visible = plane.energy_axis is not None

    def set_palette(self, palette: Palette) -> None:
        """Set the colours of the orbits' numbers."""
        self.choice.styles = {f"--orbit-{place + 1}": colour for place, colour in enumerate(palette.orbits)}

    def show_interval(self, interval: tuple[float, float] | None, duration: float) -> None:
        """Show which part of the duration is in view; None is the whole duration."""
        self._interval_row.visible = interval is not None
        if interval is not None:
            begin, end = interval
            self.interval.object = f"Shown: t = {begin:.6g} to {end:.6g} of {duration:.6g}"

    def say(self, sentence: str) -> None:
        """Show a message about the orbits."""
        self.note.object = f"<p>{escape(sentence)}</p>"

    def show_indicators(self, verdicts: Sequence[IndicatorVerdict]) -> None:
        """Show the verdict of each chaos indicator on the chosen orbit."""
        rows = "".join(
            f"<tr><th scope=row>{one.name}<br>{_value(one.value)}</th>"
            f"<td><b>{one.conclusion or 'no verdict'}</b><br>{escape(one.sentence)}</td></tr>"
            for one in verdicts
        )
        self.indicators.object = f"<table aria-label='chaos indicators'>{rows}</table>" if rows else ""

    def show(self, orbits: Sequence[ChosenOrbit], chosen: int) -> None:
        """Show the list of orbits, and the values and verdict of the chosen one."""
        starts = [one.start for one in orbits], chosen
        if starts != ([one.start for one in self._shown[0]], self._shown[1]):
            self.note.object = "" if orbits else HINT
        self._shown = (tuple(orbits), chosen)
        self.choice.param.update(
            options={_row(orbits, place): place for place in range(len(orbits))}, value=chosen if orbits else None
        )
        self._enable()
        if not orbits:
            return
        one = orbits[chosen]
        self.x.value, self.ordinate.value = (f"{number!r}" for number in one.start)
        self.text.object = f"<p><b>{escape(one.describe())}</b></p>"
        self.values.object = _values(one.orbit)

    def _enable(self) -> None:
        for one in (self.divergent_start, self.remove, self.clear, self.open_plane):
            one.disabled = not self._shown[0]

    def _choose(self, place: int | None) -> None:
        if place is not None and place != self._shown[1]:
            self._actions.choose(place)

    def _submit(self) -> None:
        try:
            start = float(self.x.value), float(self.ordinate.value)
        except ValueError:
            start = math.nan, math.nan
        if all(map(math.isfinite, start)):
            self._actions.add(*start)
        else:
            self.say("Type a number into both boxes first.")


def _row(orbits: Sequence[ChosenOrbit], place: int) -> str:
    """An orbit in the list; a start that looks like an earlier one is shown by the difference."""
    x, ordinate = orbits[place].start
    text = f"{x:.6g}, {ordinate:.6g}"
    for other, one in enumerate(orbits[:place]):
        if text == f"{one.start[0]:.6g}, {one.start[1]:.6g}":
            text = f"orbit {other + 1} + ({x - one.start[0]:.2g}, {ordinate - one.start[1]:.2g})"
    return f"{place + 1}: {text}: {_fate(orbits[place])}"


def _value(value: float) -> str:
    return f"{value:.3g}" if math.isfinite(value) else ""


def _fate(one: ChosenOrbit) -> str:
    return one.verdict.summarize() if one.verdict is not None else "none" if one.problem else "…"


def _values(orbit: Orbit | None) -> str:
    if orbit is None:
        return ""
    rows = {
        "energy h": f"{orbit.energy:.10g}",
        "start x, y": f"{orbit.x[0]:.6g}, {orbit.y[0]:.6g}",
        "start px, py": f"{orbit.px[0]:.6g}, {orbit.py[0]:.6g}",
        "upward crossings of y = 0": grouped(orbit.crossings),
        "last SALI": f"{orbit.sali[-1]:.3g}",
        "relative energy error": f"{orbit.energy_error:.1e}",
    }
    cells = "".join(f"<tr><th scope=row>{name}</th><td>{value}</td></tr>" for name, value in rows.items())
    return f"<table aria-label='values of the orbit'>{cells}</table>"
