"""Controls of the orbits: the list of orbits, verdict and values of the chosen orbit, and boxes to type a start."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape
from itertools import groupby

import panel as pn

from app.browser.components.orbit_components import OrbitList
from app.job_clients.orbit_requests import StartOrbit
from app.state.glossary import with_terms
from app.state.view_state import ViewState
from app.views.components.collapsible_section import Fold
from app.views.components.texts import TextPane
from app.views.components.widgets import FULL_HEIGHT, button, copy_button, flex_row, number_rows
from engine import Coordinate, Orbit, Section, Slice
from engine.foundations.wording import format_number, format_time, format_whole
from engine.trajectories.chaos_indicators import IndicatorVerdict
from plots.pictures.orbit_curves import initial_state
from plots.pictures.palette import PALETTES, Palette

HINT = "Click a map: the orbit that starts there is drawn, with its exit and time. Up to five."
"""Message while there are no orbits."""

# Width of the boxes, in pixels.
_BOX_WIDTH = 180
# Largest length of a typed number, in characters.
_LONGEST_NUMBER = 40


@dataclass(frozen=True)
class OrbitActions:
    """Callbacks of the buttons. `add` takes x and ordinate of a typed start, and `copy` takes a text."""

    add: Callable[[float, float], None]
    add_neighbour: Callable[[], None]
    find_periodic_orbit: Callable[[], None]
    open_section: Callable[[], None]
    show_all_times: Callable[[], None]
    copy: Callable[[str], None]


class OrbitControls:
    """Boxes for a start, the list of the orbits, and the results of the chosen orbit."""

    def __init__(self, state: ViewState, actions: OrbitActions) -> None:
        self._state, self._actions = state, actions
        self._orbits_and_chosen: tuple[tuple[StartOrbit, ...], int] = ((), 0)
        # Text boxes, because number boxes do not report Enter.
        self.x = pn.widgets.TextInput(label="x", value="0", max_length=_LONGEST_NUMBER, width=_BOX_WIDTH)
        self.ordinate = pn.widgets.TextInput(label="px", value="0", max_length=_LONGEST_NUMBER, width=_BOX_WIDTH)
        self.button = button("Integrate", self._submit, kind="primary", align="end")
        self.list = OrbitList(self._choose, visible=False)
        self.add_neighbour = button("Add this neighbour", actions.add_neighbour, margin=0, disabled=True)
        self.periodic_orbit = button("Nearest periodic orbit", actions.find_periodic_orbit, margin=0)
        self.remove = button("Remove", lambda: state.remove_start(state.chosen), margin=0)
        self.clear = button("Clear all", lambda: state.param.update(starts=(), chosen=0), margin=0)
        self.open_section = button("", actions.open_section, margin=0)
        self.interval = TextPane("", name="interval", margin=0, css_classes=["quiet"])
        all_times = button("Whole orbit", actions.show_all_times, margin=0)
        self._interval_row = flex_row(self.interval, all_times, justify="space-between", align="center")
        self._interval_row.param.update(margin=(0, 10), visible=False)
        self.text = TextPane("", name="verdict", sizing_mode="stretch_width", margin=(0, 10), css_classes=["verdict"])
        self.neighbour = TextPane("", name="neighbour", sizing_mode="stretch_width", margin=(0, 10), css_classes=["neighbour"])
        self.note = TextPane(HINT, name="note", sizing_mode="stretch_width", margin=(0, 10), css_classes=["note"])
        self.reason = TextPane("", name="reason", sizing_mode="stretch_width", margin=(0, 10))
        self.values = TextPane("", name="values", sizing_mode="stretch_width", margin=(0, 10))
        self.indicators = TextPane("", name="indicators", sizing_mode="stretch_width", margin=(0, 10))
        self._verdicts: Sequence[IndicatorVerdict] = ()
        self.copy = copy_button(self._rows, actions.copy)
        for box in (self.x, self.ordinate):
            box.param.watch(lambda event: self._submit(), "enter_pressed")
        state.follow(self._follow_plane, "plane", "section")
        state.follow(lambda name: self._set_colours(PALETTES[name]), "palette")

    def start_boxes(self) -> list[pn.viewable.Viewable]:
        """Return the boxes for a typed start, which open on demand."""
        return Fold("Type a start", lambda: [flex_row(self.x, self.ordinate, self.button, align="end")]).parts()

    def head(self, player: pn.viewable.Viewable) -> pn.viewable.Viewable:
        """Return the list of the orbits, the verdict on the chosen orbit, buttons, and the player."""
        orbits = flex_row(self.list, self.clear, justify="space-between", align="center")
        buttons = flex_row(self.add_neighbour, self.periodic_orbit, self.remove, self.open_section, gap="6px")
        orbits.margin = buttons.margin = (5, 10)
        return pn.Column(
            orbits, self.text, self.neighbour, buttons, player,
            sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT,
        )  # fmt: skip

    def details(self) -> pn.viewable.Viewable:
        """Return the interval of time in view, the verdicts of the chaos indicators, and values that open on demand."""
        values = Fold("Values", lambda: [self.reason, self.values, self.copy])
        styles = {**FULL_HEIGHT, "gap": "var(--ui-gap)"}
        return pn.Column(
            self._interval_row, self.indicators, *values.parts(), sizing_mode="stretch_width", margin=0, styles=styles
        )

    def _follow_plane(self, plane: Slice, section: Section) -> None:
        """Label the boxes with the axes of the plane."""
        self.x.label, self.ordinate.label = plane.axis_symbols
        # Along a parameter, starts belong to other potentials.
        self.periodic_orbit.visible = plane.parameter is None
        energy_or_parameter = [axis for axis in plane.axes if axis is Coordinate.H or axis is plane.parameter]
        self.open_section.visible = bool(energy_or_parameter)
        if energy_or_parameter:
            names = " and ".join(axis.symbol for axis in energy_or_parameter)
            self.open_section.label = f"Open {section.slice_of_starts.title} at this {names}"

    def _set_colours(self, palette: Palette) -> None:
        """Set the colours of the orbits' numbers."""
        self.list.styles = {f"--orbit-{index + 1}": colour for index, colour in enumerate(palette.orbits)}

    def show_interval(self, interval: tuple[float, float] | None, duration: float) -> None:
        """Show the interval of time in view; None stands for the whole duration."""
        self._interval_row.visible = interval is not None
        begin, end, total = (format_time(t) for t in (*(interval or (0.0, duration)), duration))
        self.interval.object = f"Shown: t = {begin} to {end} of {total}"

    def say(self, sentence: str) -> None:
        """Show a message about the orbits."""
        self.note.param.update(object=escape(sentence), visible=bool(sentence))

    def end_message(self, *, has_orbits: bool) -> None:
        """Remove a message about earlier orbits; without orbits, show `HINT`."""
        self.say("" if has_orbits else HINT)

    def show_neighbour(self, sentence: str, *, is_known: bool) -> None:
        """Show a sentence on the nearest start that ends elsewhere, and allow to add it if it is known."""
        self.neighbour.object = escape(sentence)
        self.add_neighbour.disabled = not is_known

    def show_indicators(self, verdicts: Sequence[IndicatorVerdict]) -> None:
        """Show the verdict of each chaos indicator on the chosen orbit."""
        self._verdicts = verdicts
        rows = _indicator_rows(verdicts)
        self.indicators.object = with_terms(f"<table aria-label='chaos indicators'>{rows}</table>") if rows else ""

    def show(self, orbits: Sequence[StartOrbit], chosen: int) -> None:
        """Show the list of the orbits, and verdict and values of the chosen orbit."""
        self._orbits_and_chosen = (tuple(orbits), chosen)
        rows = [_list_label(orbits, index) for index in range(len(orbits))]
        self.list.param.update(rows=rows, chosen=chosen, visible=bool(orbits))
        if not orbits:
            return
        chosen_orbit = orbits[chosen]
        self.x.value, self.ordinate.value = (f"{number!r}" for number in chosen_orbit.start)
        # From a start without an orbit nothing can be searched.
        self.periodic_orbit.disabled = bool(chosen_orbit.problem)
        self.text.object = escape(chosen_orbit.headline())
        self.reason.object = escape(chosen_orbit.describe())
        self.values.object = _value_table(chosen_orbit.orbit)

    def _rows(self) -> list[tuple[str, str, str]]:
        """Return the values of the chosen orbit at full precision, and value and verdict of each indicator."""
        orbits, chosen = self._orbits_and_chosen
        orbit = orbits[chosen].orbit if orbits else None
        if orbit is None:
            return []
        start = dict(zip(("x", "y", "px", "py"), initial_state(orbit), strict=True))
        verdicts = [(one.name, repr(one.value), str(one.conclusion or one.sentence)) for one in self._verdicts]
        return [*number_rows("start", start), *number_rows("orbit", orbit.numbers()), *verdicts]

    def _choose(self, index: int) -> None:
        # Orbits may have been removed in the meantime.
        if index != self._orbits_and_chosen[1] and index < len(self._state.starts):
            with pn.io.hold():
                self._state.chosen = index

    def _submit(self) -> None:
        try:
            start = float(self.x.value), float(self.ordinate.value)
        except ValueError:
            start = math.nan, math.nan
        if all(map(math.isfinite, start)):
            self._actions.add(*start)
        else:
            self.say("Type a number into both boxes first.")


def _indicator_rows(verdicts: Sequence[IndicatorVerdict]) -> str:
    """Return the rows of the table of indicators, with values last. Neighbours with the same verdict share its cell."""
    rows = ""
    for (conclusion, sentence), group in groupby(verdicts, lambda one: (one.conclusion, one.sentence)):
        names = [f"<th scope=row>{one.name}<br>{_value(one.value)}</th>" for one in group]
        verdict = f"<b>{conclusion}</b><br>" if conclusion else ""
        cell = f"<td rowspan={len(names)}>{verdict}{escape(sentence)}</td>"
        first, *others = names
        rows += f"<tr>{cell}{first}</tr>" + "".join(f"<tr>{name}</tr>" for name in others)
    return rows


def _list_label(orbits: Sequence[StartOrbit], index: int) -> str:
    """Return the label of an orbit in the list. A start that looks like an earlier start is written as a difference."""
    x, ordinate = orbits[index].start
    text = f"{format_number(x)}, {format_number(ordinate)}"
    for earlier_index, earlier in enumerate(orbits[:index]):
        earlier_x, earlier_ordinate = earlier.start
        if text == f"{format_number(earlier_x)}, {format_number(earlier_ordinate)}":
            difference = f"({format_number(x - earlier_x, 2)}, {format_number(ordinate - earlier_ordinate, 2)})"
            text = f"orbit {earlier_index + 1} + {difference}"
    return f"{index + 1}: {text}: {orbits[index].summarize()}"


def _value(value: float) -> str:
    return format_number(value, 3) if math.isfinite(value) else ""


def _value_table(orbit: Orbit | None) -> str:
    if orbit is None:
        return ""
    rows = {
        "energy h": format_number(orbit.energy, 10),
        "start x, y": f"{format_number(orbit.x[0], 6)}, {format_number(orbit.y[0], 6)}",
        "start px, py": f"{format_number(orbit.px[0], 6)}, {format_number(orbit.py[0], 6)}",
        orbit.section.crossings_name: format_whole(orbit.crossings),
        "last SALI": format_number(orbit.sali[-1], 3),
        "relative energy error": format_number(orbit.energy_error, 2),
    }
    cells = "".join(f"<tr><th scope=row>{name}</th><td>{value}</td></tr>" for name, value in rows.items())
    return f"<table aria-label='values of the orbit'>{cells}</table>"
