"""The drawer that chooses the slice, its axes and what the energy determines, and the surface of section."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from html import escape
from typing import Any

import panel as pn

from app.browser.inputs.counted_inputs import NumberBox
from app.state.view_state import ViewState
from app.views.components.texts import StatusPane, TextPane
from app.views.components.widgets import button, flex_row
from engine import Coordinate, ParameterAxis, Section, Slice, System, read_section
from engine.slices.planes import checked_slice
from engine.slices.slice_text import AXIS_NAMES, default_range
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.parameters import symbol_of

_SECTION_HINT = "Crossings are counted, and section points drawn, where an orbit meets the surface of section."
# Sections that are offered for all systems, besides those of the catalogue.
_SECTIONS = (Section.Y_UP.text, "x = 0, px > 0", "angle = 45°", "pericentre", "apocentre")
_HINT = "Starts move along the two axes. The energy decides one momentum, or the speed in a given direction."
# Labels of the modes in which the energy determines the speed, by the angle of its direction.
_ANGLES = {Coordinate.THETA: "speed, at angle θ from the x axis", Coordinate.BETA: "speed, at angle β from the radius"}
# Initial values of the angles, in radians.
_FIRST_ANGLE = {Coordinate.THETA: 0.0, Coordinate.BETA: 0.5 * math.pi}
# Step of the boxes.
_STEP = 0.05
# What the energy determines: a momentum and its sign, or the speed and the angle of its direction.
_Mode = tuple[Coordinate, int, Coordinate | None]
# The modes by label.
_MODES: dict[str, _Mode] = {
    "py > 0": (Coordinate.PY, 1, None),
    "py < 0": (Coordinate.PY, -1, None),
    "px > 0": (Coordinate.PX, 1, None),
    "px < 0": (Coordinate.PX, -1, None),
    **{text: (Coordinate.SPEED, 1, angle) for angle, text in _ANGLES.items()},
}


class SlicePanel:
    """Widgets that write the slice of the state and follow it.

    Parameters
    ----------
    state
        The view state.
    """

    def __init__(self, state: ViewState) -> None:
        self._state = state
        self._is_following = False
        self.axes = [_make_list("Horizontal axis"), _make_list("Vertical axis")]
        self.mode = _make_list("The energy decides")
        self.ranges = pn.Column(sizing_mode="stretch_width", margin=0)
        self.held = pn.Column(sizing_mode="stretch_width", margin=0)
        self.message = StatusPane("", sizing_mode="stretch_width", margin=(8, 0))
        self.section = pn.widgets.AutocompleteInput(
            label="Surface of section", restrict=False, min_characters=0, case_sensitive=False, search_strategy="includes",
            sizing_mode="stretch_width", margin=(4, 0),
        )  # fmt: skip
        self.section_message = StatusPane("", sizing_mode="stretch_width", margin=0)
        self.start_on_section = button("Start on the section", self._start_on_section, margin=(4, 0))
        self.section.param.watch(lambda event: self._take_section(event.new), "value")
        for index, axis in enumerate(self.axes):
            axis.param.watch(partial(self._take_axis, index), "value")
        self.mode.param.watch(lambda event: self._take_mode(_MODES[event.new]) if event.new else None, "value")
        state.follow(self.show, "plane", "system")
        state.follow(self.show_section, "section", "plane", "system")

    def build(self) -> list[pn.viewable.Viewable]:
        """Return the parts of a column."""
        hint = TextPane(f"<p class='quiet'>{_HINT}</p>", sizing_mode="stretch_width", margin=0)
        section_hint = TextPane(f"<p class='quiet'>{_SECTION_HINT}</p>", sizing_mode="stretch_width", margin=0)
        section = [section_hint, self.section, self.section_message, self.start_on_section]
        return [hint, *self.axes, self.ranges, self.mode, self.held, self.message, *section]

    def show(self, plane: Slice, system: System) -> None:
        """Show a slice of a system."""
        names = {_symbol(key): key for key in (*AXIS_NAMES, *system.parameter_names)}
        self._is_following = True
        try:
            for axis_list, axis in zip(self.axes, plane.axes, strict=True):
                axis_list.param.update(options=names, value=axis.key)
            self.mode.param.update(options=[text for text, mode in _MODES.items() if self._is_legal(mode)], value=_mode_of(plane))
        finally:
            self._is_following = False
        self.ranges.objects = self._range_boxes(plane)
        self.held.objects = self._held_boxes(plane)
        self.message.object = f"<p>{escape(plane.title)}</p>"

    def show_section(self, section: Section, plane: Slice, system: System) -> None:
        """Show the section, the sections of a system, and whether the starts are on the section."""
        entry = CATALOGUE.get(system.case)
        # With other parameters, bodies may be elsewhere.
        of_system = entry.sections if entry is not None and system == System(system.case) else ()
        options = dict.fromkeys(read_section(text).text for text in [*_SECTIONS[:1], *of_system, *_SECTIONS[1:]])
        self._is_following = True
        try:
            self.section.param.update(options=list(options), value=section.text)
        finally:
            self._is_following = False
        self.start_on_section.visible = section.plane not in (None, plane)
        self.section_message.object = ""

    def _take_section(self, text: str) -> None:
        if self._is_following:
            return
        try:
            section = read_section(text)
        except ValueError as error:
            self.section_message.object = f"<p role='alert'>{escape(str(error))}</p>"
            return
        with pn.io.hold():
            self._state.show_section(section, with_slice=False)
            # An equal section may be written in another way.
            self.show_section(section, self._state.plane, self._state.system)

    def _start_on_section(self) -> None:
        self._state.show_section(self._state.section, with_slice=True)

    def _range_boxes(self, plane: Slice) -> list[pn.viewable.Viewable]:
        axis = plane.parameter
        if axis is None:
            return []
        low = NumberBox(lambda value: self._take_range(value, None), axis.low, label=f"{axis.symbol} from", step=_STEP)
        high = NumberBox(lambda value: self._take_range(None, value), axis.high, label="to", step=_STEP)
        return [flex_row(low, high, gap="8px")]

    def _held_boxes(self, plane: Slice) -> list[pn.viewable.Viewable]:
        """Make a box for each coordinate that is neither an axis nor determined by the energy."""
        values = dict(plane.fixed)
        has_speed = plane.decided is Coordinate.SPEED
        momenta = [c for c in (Coordinate.PX, Coordinate.PY) if c is not plane.decided and not has_speed]
        angles = [angle for angle in _ANGLES if angle in values]
        boxes = [
            NumberBox(partial(self._take_held, c), values.get(c, 0.0), label=f"{c.symbol} =", step=_STEP)
            for c in (Coordinate.X, Coordinate.Y, *momenta, *angles)
            if c not in plane.axes
        ]
        return [flex_row(*boxes, gap="8px")] if boxes else []

    def _is_legal(self, mode: _Mode) -> bool:
        try:
            self._changed_slice(mode=mode)
        except ValueError:
            return False
        return True

    def _take_axis(self, index: int, event: Any) -> None:
        plane, system = self._state.plane, self._state.system
        if self._is_following or event.new is None or event.new == plane.axes[index].key:
            return
        if event.new in system.parameter_names:
            axis: Any = ParameterAxis(event.new, *default_range(system, event.new), system)
        else:
            axis = Coordinate(event.new)
        axes = (axis, plane.ordinate) if index == 0 else (plane.abscissa, axis)
        if event.new == plane.axes[1 - index].key:
            # A choice of the present other axis exchanges the axes.
            axes = plane.ordinate, plane.abscissa
        self._submit(lambda: _with_axes(plane, axes))

    def _take_mode(self, mode: _Mode) -> None:
        if not self._is_following:
            self._submit(lambda: self._changed_slice(mode=mode))

    def _take_held(self, coordinate: Coordinate, value: float) -> None:
        self._submit(lambda: self._changed_slice(fixed={**dict(self._state.plane.fixed), coordinate: value}))

    def _take_range(self, low: float | None, high: float | None) -> None:
        axis = self._state.plane.parameter
        if axis is None:
            return
        new_low = axis.low if low is None else low
        new_high = axis.high if high is None else high

        def change_range() -> Slice:
            new_axis = ParameterAxis(axis.key, new_low, new_high, axis.system)
            plane = self._state.plane
            axes = tuple(new_axis if each is axis else each for each in plane.axes)
            return Slice(axes[0], axes[1], plane.solved, plane.sign, plane.fixed)

        self._submit(change_range)

    def _changed_slice(self, mode: _Mode | None = None, fixed: dict[Coordinate, float] | None = None) -> Slice:
        """Return the slice of the state with another mode or other held values."""
        plane = self._state.plane
        held = dict(plane.fixed) if fixed is None else fixed
        if mode is None:
            return Slice(plane.abscissa, plane.ordinate, plane.solved, plane.sign, tuple(held.items()))
        solved, sign, angle = mode
        kept = {c: value for c, value in held.items() if c in (Coordinate.X, Coordinate.Y)}
        if angle is None:
            kept |= {c: value for c, value in held.items() if c in (Coordinate.PX, Coordinate.PY) and c is not solved}
        elif angle not in plane.axes:
            kept[angle] = held.get(angle, _FIRST_ANGLE[angle])
        return Slice(plane.abscissa, plane.ordinate, solved, sign, tuple(kept.items()))

    def _submit(self, make: Callable[[], Slice]) -> None:
        """Set the slice of the state, or show why the slice is not possible."""
        try:
            chosen = checked_slice(make())
        except ValueError as error:
            self.message.object = f"<p role='alert'>{escape(str(error))}</p>"
            self._follow_axes()
        else:
            # `hold` provides the session's lock, as in `app.views.components.widgets.button`.
            with pn.io.hold():
                self._state.show_slice(chosen)

    def _follow_axes(self) -> None:
        """Show the axes of the state in place of a refused choice."""
        for axis_list, axis in zip(self.axes, self._state.plane.axes, strict=True):
            axis_list.value = axis.key


def _make_list(label: str) -> pn.widgets.Select:
    return pn.widgets.Select(label=label, sizing_mode="stretch_width", margin=(4, 0))


def _symbol(key: str) -> str:
    return Coordinate(key).symbol if key in AXIS_NAMES else symbol_of(key)


def _mode_of(plane: Slice) -> str:
    """Return the label of the quantity that the energy determines on a slice."""
    if plane.decided is Coordinate.SPEED:
        coordinates = (*plane.axes, *dict(plane.fixed))
        return next(text for angle, text in _ANGLES.items() if angle in coordinates)
    return next(text for text, mode in _MODES.items() if mode == (plane.decided, plane.sign, None))


def _with_axes(plane: Slice, axes: tuple[Any, Any]) -> Slice:
    """Return a slice with other axes, and with the determined momentum and the held values if the new axes permit them.

    Raises ValueError if no slice has these axes.
    """
    kept = tuple((c, value) for c, value in plane.fixed if c not in axes)
    for solved, sign, fixed in ((plane.solved, plane.sign, kept), (None, 1, kept), (None, 1, ())):
        try:
            return Slice(*axes, solved, sign, fixed)
        except ValueError as error:
            problem = error
    raise problem
