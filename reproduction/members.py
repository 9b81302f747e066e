"""Choose members of the reproduction (the figures and the tables) and make their files."""

from __future__ import annotations

from collections.abc import Sequence

from reproduction.figures.all_figures import FIGURES
from reproduction.map_cache import MapCache
from reproduction.numbers.comparisons import compare_all
from reproduction.tables.report import write_report, write_table

TABLES = "tables"
"""Name of the only member that is not a figure."""

CAPTIONS = {
    **{name: entry.caption for name, entry in FIGURES.items()},
    TABLES: "All numbers stated in the paper with the computed ones, as Markdown and CSV",
}
"""Captions of the members by name, in an order that reuses maps."""


def choose_members(names: Sequence[str]) -> list[str]:
    """Select members by name, each once and in order; without names, select all members.

    Raises
    ------
    ValueError
        If a name is unknown.
    """
    for name in names:
        if name not in CAPTIONS:
            raise ValueError(f"name={name!r}: must be one of {', '.join(CAPTIONS)}")
    return [name for name in CAPTIONS if not names or name in names]


def make_files(name: str, cache: MapCache) -> dict[str, str | bytes]:
    """Return the content of the files of a member, by file name. This may take minutes.

    Raises
    ------
    concurrent.futures.CancelledError
        If the cache is cancelled.
    """
    if name != TABLES:
        return dict(FIGURES[name].files(cache))
    search = cache.super_sticky()
    rows = compare_all(cache, search)
    return {"reproduction.md": write_report(cache, search, rows), "reproduction.csv": write_table(rows)}
