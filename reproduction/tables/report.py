"""Report the numbers of the paper and the computed numbers, as Markdown and as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from importlib import metadata

import numpy as np

from engine import CASES
from reproduction.map_cache import MapCache
from reproduction.notation import write_rows
from reproduction.numbers.comparisons import PERCENT, POINTS, Comparison
from reproduction.numbers.map_structure import BOUNDARY_PIXELS
from reproduction.numbers.stated_numbers import Counting, StatedNumber
from reproduction.numbers.unknown_windows import STEP
from reproduction.super_sticky import SuperStickySearch
from reproduction.tables.fit_sections import write_fits, write_laws
from reproduction.tables.late_sections import write_late_escapes, write_super_sticky

# Headings of the tables of the report.
_REPORT_HEADINGS = ("quantity", "h", "paper", "computed, inside", "difference", "best window", "computed in it", "reason")
# Headings of the CSV table.
_CSV_HEADINGS = (
    "case", "plane", "h", "what", "relation", "stated", "unit", "computed", "difference", "needs_window", "agrees",
    "half_side", "right_edge", "outside_share", "counted", "counted_difference", "agrees_when_counted", "derivation", "reason",
)  # fmt: skip
# Smallest number of computed values that are listed with their energies after their range.
_SHORTEST_LIST = 4


def write_report(cache: MapCache, search: SuperStickySearch, rows: tuple[Comparison, ...]) -> str:
    """Write the report as Markdown.

    Parameters
    ----------
    cache
        Source of the maps. The report states the quality of the maps.
    search
        Search for super-sticky orbits of case III at h = 0.26.
    rows
        Result of `compare_all`.

    Raises
    ------
    concurrent.futures.CancelledError
        If the cache is cancelled.
    """
    parts = ["# Comparison with the numbers of the paper", _introduce(cache, search), "## Summary", describe_verdict(rows)]
    for case, potential in CASES.items():
        case_rows = [row for row in rows if row.stated.case == case]
        parts += [f"## Case {case}: {potential.channels} channels", write_rows(_REPORT_HEADINGS, map(_report_row, case_rows))]
    parts += ["## Fits", write_fits(cache), "## Late escapes", write_laws(cache)]
    parts += ["## Chaotic bounded orbits", write_late_escapes(cache), "## Super-sticky orbits", write_super_sticky(search)]
    parts += ["## Open points of the paper", _OPEN_POINTS]
    return "\n\n".join(parts) + "\n"


def describe_verdict(rows: Sequence[Comparison]) -> str:
    """Say how many of the stated numbers are reproduced, and list the window-independent numbers that are not."""
    shares = [row for row in rows if row.stated.is_share]
    free_shares = [row for row in shares if not row.stated.needs_window]
    window_shares = [row for row in shares if row.stated.needs_window]
    other_numbers = [row for row in rows if not row.stated.is_share]
    counted_agreeing = sum(row.agrees or row.agrees_when_counted for row in window_shares)
    sentences = (
        f"**Of the {len(free_shares)} percentages that do not depend on a window, {_count_agreeing(free_shares)} agree within "
        f"{POINTS:g} percentage points.** "
        f"Of the {len(window_shares)} that depend on a window that is not stated, {_count_agreeing(window_shares)} agree for the "
        f"starts inside alone, "
        f"and {counted_agreeing} if starts outside are counted in the best window. "
        f"Of the {len(other_numbers)} other numbers, {_count_agreeing(other_numbers)} agree within {PERCENT:g} %."
    )
    failing = [row for row in (*free_shares, *other_numbers) if not row.agrees]
    lines = [
        f"- {_describe_place(row.stated)}: {_describe_value(row.stated)} {'derived' if row.stated.derivation else 'stated'}, "
        f"{_describe_computed(row)} computed. {row.reason}".rstrip()
        for row in failing
    ]
    if not lines:
        return sentences
    return "\n\n".join([sentences, "Numbers that do not depend on a window and differ:", "\n".join(lines)])


def write_table(rows: Sequence[Comparison]) -> str:
    """Write the rows as CSV, with one line per energy, shares in percent, and empty cells for missing values."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(_CSV_HEADINGS)
    for row in rows:
        for index, value in enumerate(row.computed):
            table.writerow(_table_row(row, index, value))
    return text.getvalue()


def _table_row(row: Comparison, index: int, value: float) -> tuple[object, ...]:
    """Return the CSV row of one computed value."""
    stated = row.stated
    window = row.windows[index] if row.windows else None
    is_by_energy = len(row.computed) == len(stated.energies)
    return (
        stated.case, stated.plane.title if stated.plane else "", stated.energies[index] if is_by_energy else stated.at,
        _describe_quantity(stated), stated.relation.value, f"{stated.value:.6g}", _unit(stated), _format_cell(value),
        _format_cell(row.difference), int(stated.needs_window), int(row.agrees),
        *(("",) * 6 if window is None else (
            f"{window.half_side:g}", f"{window.window.x_high:g}", f"{window.outside_share:.4g}",
            f"{row.counted_shares[index]:.6g}", f"{row.counted_difference:.6g}", int(row.agrees_when_counted),
        )),
        stated.derivation, row.reason,
    )  # fmt: skip


def _format_cell(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.6g}"


def _introduce(cache: MapCache, search: SuperStickySearch) -> str:
    quality = cache.quality
    return _INTRODUCTION.format(
        version=metadata.version("escape-explorer"),
        quality=quality.name,
        side=quality.resolution,
        t_max=f"{quality.t_max:g}",
        search_side=search.spec.resolution[0],
        classified_side=quality.classified_resolution,
        boundary_pixels=BOUNDARY_PIXELS,
        step=f"{STEP:g}",
        points=f"{POINTS:g}",
        percent=f"{PERCENT:g}",
    )


def _report_row(row: Comparison) -> tuple[str, ...]:
    """Return the cells of a number in the report, in the order of `_REPORT_HEADINGS`."""
    stated = row.stated
    plane = f" on {stated.plane.title}" if stated.plane else ""
    difference = _format_difference(row.difference, stated)
    window, counted = "not needed" if stated.is_share else "", ""
    if stated.counting is Counting.INTERIOR:
        window = "inside"
    if row.windows:
        percentages_outside = [100 * fitted.outside_share for fitted in row.windows]
        window = f"{_describe_windows(row)}, {_format_range(percentages_outside, '{:.0f}')} % outside"
        counted = f"{_format_range(row.counted_shares, '{:.1f}')} % ({_format_difference(row.counted_difference, stated)})"
    return (
        f"{_describe_quantity(stated)}{plane}", stated.at, _describe_stated(stated), _describe_computed(row),
        difference if row.agrees else f"**{difference}**", window, counted, "" if row.agrees else _explain(row),
    )  # fmt: skip


def _describe_windows(row: Comparison) -> str:
    """Describe the range of half sides, and of right edges that differ."""
    windows = [fitted.window for fitted in row.windows]
    square = f"±{_format_range([window.ordinate_high for window in windows], '{:.2f}')}"
    if all(window.x_high == window.ordinate_high for window in windows):
        return square
    return f"{square}, right edge {_format_range([window.x_high for window in windows], '{:.2f}')}"


def _explain(row: Comparison) -> str:
    """Return the reasons for a difference, and the difference that is left in the fitted windows."""
    reasons = [row.reason] if row.reason else []
    if any(fitted.window.x_high != fitted.half_side for fitted in row.windows):
        reasons.append(f"No square centred on the origin is within {POINTS:g} points.")
    if row.windows:
        distance = f"within {POINTS:g}" if row.agrees_when_counted else f"still {abs(row.counted_difference):.1f}"
        reasons.append(f"With starts outside counted the difference is {distance} points.")
    return " ".join(reasons)


def _describe_place(stated: StatedNumber) -> str:
    plane = f", {stated.plane.title}" if stated.plane else ""
    at = f", h {stated.at}" if stated.at else ""
    return f"{stated.case}{plane}{at}: {_describe_quantity(stated)}"


def _describe_quantity(stated: StatedNumber) -> str:
    channels = " + ".join(map(str, stated.channels))
    return f"{stated.quantity.value} {channels}".strip()


def _describe_stated(stated: StatedNumber) -> str:
    """Return the number of the paper, with its derivation."""
    return f"{_describe_value(stated)} (derived: {stated.derivation})" if stated.derivation else _describe_value(stated)


def _describe_value(stated: StatedNumber) -> str:
    value = f"{stated.value:.3g} %" if stated.is_share else f"{stated.value:.6g}"
    return f"{stated.relation.value} {value}".strip()


def _describe_computed(row: Comparison) -> str:
    """Return the range of the computed values. Several different values are also listed with their energies."""
    form, unit = ("{:.1f}", " %") if row.stated.is_share else ("{:.4g}", "")
    value_range = _format_range(row.computed, form)
    is_single = " to " not in value_range
    if is_single or len(row.computed) < _SHORTEST_LIST:
        return value_range + unit
    values = ("none" if np.isnan(value) else form.format(value) for value in row.computed)
    listed = ", ".join(f"{value} at {energy:g}" for value, energy in zip(values, row.stated.energies, strict=True))
    return f"{value_range}{unit} ({listed})"


def _format_range(values: Sequence[float], form: str) -> str:
    if np.isnan(values).all():
        return "none"
    low, high = form.format(np.nanmin(values)), form.format(np.nanmax(values))
    return low if low == high else f"{low} to {high}"


def _format_difference(difference: float, stated: StatedNumber) -> str:
    if np.isnan(difference):
        return "none"
    return (f"{difference:+.1f}" if stated.is_share else f"{difference:+.3g}").replace("-", "−")


def _unit(stated: StatedNumber) -> str:
    return "%" if stated.is_share else "1"


def _count_agreeing(rows: Sequence[Comparison]) -> int:
    return sum(row.agrees for row in rows)


_INTRODUCTION = """\
E. E. Zotos, *Escapes in Hamiltonian systems with multiple exit channels: Part I*, Nonlinear Dynamics (2014),
doi 10.1007/s11071-014-1524-9, states the numbers below in its text. `escape-explorer reproduce tables` computes them and writes
this page.

Computed with version {version} at {quality} quality: {side} × {side} starts per map, integrated to t = {t_max};
{search_side} × {search_side} starts for the super-sticky orbits; bounded orbits of I and II classified on {classified_side} ×
{classified_side}. The paper has up to 225 × 225 starts and t = 100 000. Numbers of starts per side are even here: with an odd
number a column lies on the symmetry line x = 0, where orbits of III with px = 0 never escape.

Numbers that the text does not state, but implies, are marked as derived.

Shares are percentages of the starts inside, which are allowed and do not lie beyond a Lyapunov orbit. On (x, px) of I and III
there are no others. Elsewhere the paper seems to count starts outside as well, as escapes through the exit beyond which they lie,
in a window that it does not state. For these numbers both are given: the share inside, and the share in the square centred on the
origin that best explains all numbers stated for the map, in steps of {step}. If no square is within {points} points, its right
edge is fitted as well.

Some statements need a definition:

- A start is inside a basin if it and its eight neighbours escape through the same exit.
- A start on a boundary is next to all basins if the boundary of each basin is within {boundary_pixels} pixels (Wada).
- The uncertainty exponent stands for the fat-fractal exponent of a footnote: both are 1 if there is no
  fractal.
- Escape times near islands and near exits are medians over the neighbours of bounded starts and of starts outside.

Differences are computed − stated, in percentage points for shares; the largest for several energies; 0 if a stated bound holds.
Bold differences are larger than {points} points, or {percent} % for numbers that are not shares."""

_OPEN_POINTS = """\
- The test for saddles in the paper omits the square of the mixed derivative; it is included here.
- At h = 0.26 the paper draws the Lyapunov orbits of III at R² = 1.26; the table of case III gives R² on them.
- The windows of its percentages are not stated; where they matter, a window is fitted.
- Percentages stated for one map do not always sum to 100: II on (x, y) at 0.17 to 102, III on (x, y) at 0.26 to 106.
- The text states no numbers for dN_n and p_n; their panels are reproduced as figures."""
