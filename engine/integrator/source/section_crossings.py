"""Crossings of a surface of section in a step, as operations that are appended to the straight-line program of the step."""

from __future__ import annotations

from engine.integrator.source.section_numbers import NAMES, ROUNDING, SectionForm
from engine.integrator.source.series import ORDER, Series, cauchy
from engine.integrator.source.step_flags import HIDDEN, flag_hidden_crossings, largest_sag
from engine.integrator.source.straight_line import StraightLine, Value, where

_State = tuple[Value, Value, Value, Value]


def section_places(first_row: int) -> dict[str, tuple[int, int]]:
    """Return the places (row, column) in `gates` of the numbers of a section whose rows begin at `first_row`."""
    return {
        f"section_{name}": (first_row + row, column)
        for row, names in enumerate(NAMES)
        for column, name in enumerate(names)
        if name
    }


def flag_crossings(
    program: StraightLine, form: SectionForm, series: tuple[Series, Series], end: _State, h: Value
) -> tuple[Value, Value]:
    """Return whether a step crosses the section between its ends, and HIDDEN or 0, whether that can be wrong.

    series: x and y in the step; end: the state at its end. A step is flagged if it may cross the section twice, or if it crosses
    the section where it may also change the side.
    """
    x, y = series
    start = (x[0], y[0], x[1], y[1])
    before, after = _form_value(program, form, start), _form_value(program, form, end)
    hidden = flag_hidden_crossings([before, *_form_series(program, form, x, y)[1:]], after, h)
    start_side, end_side = _side(program, start), _side(program, end)
    sag = abs(program.input("section_side_x")) * largest_sag(x, h) + abs(program.input("section_side_y")) * largest_sag(y, h)
    lower = where(start_side < end_side, start_side, end_side)
    upper = where(start_side < end_side, end_side, start_side)
    changes_side = (before * after <= 0.0) & (lower < sag) & (upper >= 0.0 - sag)
    is_on_side = end_side >= 0.0
    falls = where((before > 0.0) & (after <= 0.0) & (program.input("section_both") > 0.0), 1, 0)
    crosses = where((before < 0.0) & (after >= 0.0), 1, falls) > 0
    return crosses & is_on_side, where(changes_side, HIDDEN, hidden)


def _form_value(program: StraightLine, form: SectionForm, state: _State) -> Value:
    """Return the form at a state; 0 where it is smaller than its rounding errors."""
    x, y, px, py = state
    names = ("x", "y", "px", "py")
    terms = [program.input(f"section_{name}") * value for name, value in zip(names, state, strict=True)]
    if form is SectionForm.RADIAL:
        radial = program.input("section_radial")
        terms += [radial * (x * px), radial * (y * py)]
    value = program.input("section_value")
    total, size = 0.0 - value, abs(value)
    for term in terms:
        total, size = total + term, size + abs(term)
    return where(abs(total) > ROUNDING * size, total, 0.0)


def _form_series(program: StraightLine, form: SectionForm, x: Series, y: Series) -> list[Value]:
    """Return the series of the form, whose first coefficient lacks the value of the section."""
    of_x, of_y, of_px, of_py = (program.input(f"section_{name}") for name in ("x", "y", "px", "py"))
    series = [of_x * x[k] + of_y * y[k] for k in range(ORDER + 1)]
    for k in range(ORDER):
        slope = of_px * x[k + 1] + of_py * y[k + 1]
        if form is SectionForm.RADIAL:
            # x px + y py is half the derivative of x² + y².
            slope = slope + program.input("section_radial") * (cauchy(x, x, k + 1) + cauchy(y, y, k + 1))
        series[k] = series[k] + (k + 1.0) * slope
    return series


def _side(program: StraightLine, state: _State) -> Value:
    """Return a number that is not negative on the side of the section that counts."""
    x, y, _, _ = state
    return program.input("section_side_x") * x + program.input("section_side_y") * y - program.input("section_side_value")
