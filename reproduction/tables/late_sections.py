"""Write the sections of the report on chaotic bounded orbits and their late escapes."""

from __future__ import annotations

from engine import CASES
from reproduction.map_cache import MapCache
from reproduction.notation import write_rows
from reproduction.paper_ranges import STICKY_CASE, nine_energies
from reproduction.super_sticky import SuperStickySearch

# Number of late escapes in the table.
_LIST_LENGTH = 20

_CHAOTIC_INTRODUCTION = """\
Cases I and II on (x, px), {side} × {side} starts; energies without bounded starts are left out. Orbits are bounded if they are
inside at t = {t_max}, and chaotic if SALI is at most 1e-7 by then. The chaotic ones are continued to t = {search_t_max}. Orbits
that are enclosed by invariant tori never leave; where some leave, the others may do so later."""

_SEARCH_INTRODUCTION = """\
Case III at h = {h:g} on (x, px), {side} × {side} starts. {found} {stays} have not escaped by then.

The paper states that all escape by 3.5e6, and shows one that escapes through exit 2 at about 851 000. At such times rounding
errors have grown to the size of the well: the escape time of a given orbit depends on rounding, in the paper and here; the number
of escapes hardly does."""


def write_late_escapes(cache: MapCache) -> str:
    """Return a table of the bounded orbits of I and II: how many are chaotic, and how many chaotic orbits leave later."""
    cases = [case for case in CASES if case != STICKY_CASE]
    searches = [(case, h, cache.late_escapes(case, h)) for case in cases for h in nine_energies(case)]
    rows = [(case, f"{h:g}", *_describe_late(search)) for case, h, search in searches if search.bounded_count]
    quality = cache.quality
    introduction = _CHAOTIC_INTRODUCTION.format(
        side=quality.classified_resolution, t_max=f"{quality.t_max:g}", search_t_max=f"{quality.search_t_max:g}"
    )
    headings = ("case", "h", "bounded", "chaotic", "chaotic share", "of these leave", "last escape")
    return "\n\n".join([introduction, write_rows(headings, rows)])


def _describe_late(search: SuperStickySearch) -> tuple[str, ...]:
    """Return the cells of the row of one energy."""
    escapers = search.escapers
    last_time = f"{search.escape_time[escapers[-1]]:.4g}" if escapers.size else "none"
    share = f"{100.0 * search.chaotic_share:.1f} %"
    return str(search.bounded_count), str(search.fate.size), share, str(escapers.size), last_time


def write_super_sticky(search: SuperStickySearch) -> str:
    """Return a summary of the search for super-sticky orbits, and a table of the last escapes."""
    last_escapers = search.escapers[-_LIST_LENGTH:]
    rows = [
        (
            f"{search.escape_time[k]:.0f}",
            f"{search.fate[k]}",
            f"{search.crossings[k]}",
            f"{search.x[k]:.6f}",
            f"{search.ordinate[k]:.6f}",
        )
        for k in last_escapers
    ]
    stays = search.fate.size - search.escapers.size
    introduction = _SEARCH_INTRODUCTION.format(
        h=search.spec.energy, side=search.spec.resolution[0], found=search.describe(), stays=stays
    )
    headings = ("escape time", "channel", "upward crossings", "x", "px")
    return "\n\n".join([introduction, write_rows(headings, rows)]) if rows else introduction
