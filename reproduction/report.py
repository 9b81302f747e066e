"""Every number of the paper beside ours, as a page and as a table.

`compare_all(shelf, hunt)` (reproduction/comparisons.py) computes the rows; `write_report(shelf, hunt)` is the Markdown page
(docs/reproduction.md), `write_table(rows)` the same rows as CSV. `hunt` is what `shelf.hunt()` gives.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from importlib import metadata

import numpy as np

from engine import CASES, SuperStickySearch
from reproduction.comparisons import JUDGED_SIDE, PERCENT, POINTS, Comparison, compare_all
from reproduction.fit_sections import write_fits, write_laws
from reproduction.map_shelf import MapShelf
from reproduction.markdown import write_rows
from reproduction.stated_numbers import Counting, StatedNumber
from reproduction.unknown_windows import STEP

_HEADS = ("what", "h", "stated", "ours, inside", "difference", "window that fits best", "ours in it", "why they differ")
_COLUMNS = (
    "case", "plane", "h", "what", "relation", "stated", "unit", "ours", "difference", "needs_window", "agrees",
    "half_side", "right_edge", "outside_share", "counted", "counted_difference", "agrees_when_counted", "remark",
)  # fmt: skip
# Of those that left, the latest that are listed.
_LISTED = 20


def write_report(shelf: MapShelf, hunt: SuperStickySearch, rows: tuple[Comparison, ...] | None = None) -> str:
    """The page, in Markdown.

    Parameters
    ----------
    shelf
        Of the maps; their quality is stated on the page.
    hunt
        The super-sticky orbits of case III at h = 0.26.
    rows
        What `compare_all` gives for these, when it is there already; None to compute it.

    Raises
    ------
    concurrent.futures.CancelledError
        When the shelf is stopped.
    """
    rows = compare_all(shelf, hunt) if rows is None else rows
    parts = ["# The paper's numbers beside ours", _introduce(shelf, hunt), "## Verdict", describe_verdict(rows)]
    for case, potential in CASES.items():
        mine = [row for row in rows if row.stated.case == case]
        parts += [f"## Case {case}: {potential.channels} channels", write_rows(_HEADS, map(_page_row, mine))]
    parts += ["## Fits", write_fits(shelf), "## How the last ones leave", write_laws(shelf)]
    parts += ["## Super-sticky orbits", _describe_hunt(hunt), "## What the paper leaves open", _OPEN]
    return "\n\n".join(parts) + "\n"


def describe_verdict(rows: Sequence[Comparison]) -> str:
    """How many of the stated numbers we find, and which not."""
    shares = [row for row in rows if row.stated.is_share]
    free, bound = ([row for row in shares if row.stated.needs_window is needs] for needs in (False, True))
    others = [row for row in rows if not row.stated.is_share]
    found, inside = _count(free), _count(bound)
    counted = sum(row.agrees or row.agrees_when_counted for row in bound)
    sentences = (
        f"**Of the {len(free)} percentages that need no window, {found} are within {POINTS:g} points of ours.** "
        f"Of the {len(bound)} that depend on a window that is not stated, {inside} are so for the starts inside alone, "
        f"and {counted} when starts outside may be counted in the window that fits best. "
        f"Of the {len(others)} other numbers, {_count(others)} agree to {PERCENT:g} %."
    )
    failing = [row for row in (*free, *others) if not row.agrees]
    lines = [
        f"- {_describe_place(row.stated)}: {_stated(row.stated)} stated, {_ours(row)} ours. {row.stated.remark}"
        for row in failing
    ]
    return "\n\n".join([sentences, "Those that need no window and differ:", "\n".join(lines)]) if lines else sentences


def write_table(rows: Sequence[Comparison]) -> str:
    """The rows as CSV, a line for each energy; shares in percent, empty where there is nothing."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(_COLUMNS)
    for row in rows:
        for place, value in enumerate(row.ours):
            table.writerow(_table_row(row, place, value))
    return text.getvalue()


def _table_row(row: Comparison, place: int, value: float) -> tuple[object, ...]:
    stated, window = row.stated, row.windows[place] if row.windows else None
    by_energy = len(row.ours) == len(stated.energies)
    return (
        stated.case, stated.plane.value if stated.plane else "", stated.energies[place] if by_energy else stated.at,
        _describe_quantity(stated), stated.relation.value, f"{stated.value:.6g}", _unit(stated), f"{value:.6g}",
        f"{row.difference:.6g}", int(stated.needs_window), int(row.agrees),
        *(("",) * 6 if window is None else (
            f"{window.half_side:g}", f"{window.window.x_high:g}", f"{window.outside_share:.4g}", f"{row.counted[place]:.6g}",
            f"{row.counted_difference:.6g}", int(row.agrees_when_counted),
        )),
        stated.remark if not row.agrees else "",
    )  # fmt: skip


def _introduce(shelf: MapShelf, hunt: SuperStickySearch) -> str:
    quality = shelf.quality
    return _INTRODUCTION.format(
        version=metadata.version("escape-explorer"),
        quality=quality.name,
        side=quality.resolution,
        t_max=f"{quality.t_max:g}",
        hunt_side=hunt.spec.resolution[0],
        judged_side=min(quality.resolution, JUDGED_SIDE),
        step=f"{STEP:g}",
        points=f"{POINTS:g}",
        percent=f"{PERCENT:g}",
    )


def _page_row(row: Comparison) -> tuple[str, ...]:
    stated = row.stated
    plane = f" on {stated.plane.value}" if stated.plane else ""
    difference = _signed(row.difference, stated)
    window, counted = "none needed" if stated.is_share else "", ""
    if stated.counting is Counting.INTERIOR:
        window = "inside"
    if row.windows:
        window = f"{_describe_windows(row)}, {_range([100 * fitted.outside_share for fitted in row.windows], '{:.0f}')} % outside"
        counted = f"{_range(row.counted, '{:.1f}')} % ({_signed(row.counted_difference, stated)})"
    return (
        f"{_describe_quantity(stated)}{plane}", stated.at or "", _stated(stated), _ours(row),
        difference if row.agrees else f"**{difference}**", window, counted, "" if row.agrees else _explain(row),
    )  # fmt: skip


def _describe_windows(row: Comparison) -> str:
    """Both half sides, and the right edge where it lies elsewhere."""
    windows = [fitted.window for fitted in row.windows]
    square = f"±{_range([window.ordinate_high for window in windows], '{:.2f}')}"
    if all(window.x_high == window.ordinate_high for window in windows):
        return square
    return f"{square}, right edge {_range([window.x_high for window in windows], '{:.2f}')}"


def _explain(row: Comparison) -> str:
    """One sentence where they differ."""
    remark = [row.stated.remark] if row.stated.remark else []
    if row.windows:
        near = f"within {POINTS:g} points" if row.agrees_when_counted else f"still {abs(row.counted_difference):.1f} points off"
        remark.append(f"With starts outside counted it is {near}.")
    return " ".join(remark)


def _describe_place(stated: StatedNumber) -> str:
    plane = f", {stated.plane.value}" if stated.plane else ""
    at = f", h {stated.at}" if stated.at else ""
    return f"{stated.case}{plane}{at}: {_describe_quantity(stated)}"


def _describe_quantity(stated: StatedNumber) -> str:
    channels = " + ".join(map(str, stated.channels))
    return f"{stated.quantity.value} {channels}".strip()


def _stated(stated: StatedNumber) -> str:
    value = f"{stated.value:.3g} %" if stated.is_share else f"{stated.value:.6g}"
    return f"{stated.relation.value} {value}".strip()


def _ours(row: Comparison) -> str:
    return f"{_range(row.ours, '{:.1f}')} %" if row.stated.is_share else _range(row.ours, "{:.4g}")


def _range(values: Sequence[float], form: str) -> str:
    if np.isnan(values).all():
        return "none"
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low} to {high}"


def _signed(difference: float, stated: StatedNumber) -> str:
    if np.isnan(difference):
        return "none"
    return (f"{difference:+.1f}" if stated.is_share else f"{difference:+.3g}").replace("-", "−")


def _unit(stated: StatedNumber) -> str:
    return "%" if stated.is_share else "1"


def _count(rows: Sequence[Comparison]) -> int:
    return sum(row.agrees for row in rows)


def _describe_hunt(hunt: SuperStickySearch) -> str:
    places = hunt.leavers[-_LISTED:]
    rows = [
        (f"{hunt.escape_time[k]:.0f}", f"{hunt.fate[k]}", f"{hunt.crossings[k]}", f"{hunt.x[k]:.6f}", f"{hunt.ordinate[k]:.6f}")
        for k in places
    ]
    stays = hunt.fate.size - hunt.leavers.size
    intro = _HUNT.format(h=hunt.spec.energy, side=hunt.spec.resolution[0], found=hunt.describe(), stays=stays)
    heads = ("escape time", "channel", "upward crossings", "x", "px")
    return "\n\n".join([intro, write_rows(heads, rows)]) if rows else intro


_INTRODUCTION = """\
E. E. Zotos, *Escapes in Hamiltonian systems with multiple exit channels: Part I*, Nonlinear Dynamics (2014),
doi 10.1007/s11071-014-1524-9, states the numbers below in its text. Ours are computed, and this page is written by
`escape-explorer reproduce tables`.

Made with version {version} at {quality} quality: {side} × {side} starts a map, followed to t = {t_max}; {hunt_side} × {hunt_side}
for the super-sticky orbits; bounded orbits of I and II judged on {judged_side} × {judged_side}. The paper has up to
225 × 225 starts and t = 100 000.

Shares are percentages of the starts inside, which exist and do not lie beyond a Lyapunov orbit already. On (x, px) of I and III
no others exist. Elsewhere the paper seems to count those outside too, as having left through the channel they lie in, in a window
it does not state. There we give both: the inside alone, and the square about the origin that comes nearest to all that is stated
of this map, in steps of {step}; where no square comes within {points} points, its right edge may be moved if that does.

Differences are ours less the paper's, in points of percentage for shares; of several energies the largest; 0 where a bound holds.
Bold ones are larger than {points} points, or {percent} % of what is no share."""

_HUNT = """\
Case III at h = {h:g} on (x, px), {side} × {side} starts. {found} {stays} have not left by then.

The paper says that all leave, by 3.5e6, and shows one that leaves through channel 2 at about 851 000. At such times an orbit has
long forgotten its start to the last digit: when a given one leaves is an accident of rounding, in the paper as here; how many
leave is not."""

_OPEN = """\
- Its test for saddles leaves out the square of the mixed derivative; ours has it.
- At h = 0.26 it draws the Lyapunov orbits of III at R² = 1.26; on them R² is what the table of case III gives.
- Windows of its percentages are not stated; where they matter we look for one that explains them.
- Percentages stated of one map do not always sum to 100: II on (x, y) at 0.17 to 102, III on (x, y) at 0.26 to 106.
- Of dN_n and p_n its text gives no number; its panels are remade as figures."""
