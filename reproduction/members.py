"""What a reproduction consists of: every figure, and the tables of numbers; what is asked for by name, and the files of each."""

from __future__ import annotations

from collections.abc import Sequence

from reproduction.comparisons import compare_all
from reproduction.figures import FIGURES
from reproduction.map_shelf import MapShelf
from reproduction.report import write_report, write_table

TABLES = "tables"
"""The name of what is no figure."""

CAPTIONS = {
    **{name: entry.caption for name, entry in FIGURES.items()},
    TABLES: "Every number that the paper states beside ours, as a page and as a table",
}
"""What each member shows, by its name; in the order in which they are made, so that maps are shared best."""


def choose_members(names: Sequence[str]) -> list[str]:
    """What is to be made, each once and in order: all of it when nothing is named.

    Raises
    ------
    ValueError
        When there is nothing of a name.
    """
    for name in names:
        if name not in CAPTIONS:
            raise ValueError(f"name={name!r}: must be one of {', '.join(CAPTIONS)}")
    return [name for name in CAPTIONS if not names or name in names]


def make_files(name: str, shelf: MapShelf) -> dict[str, str | bytes]:
    """The content of each file of a member, by the file's name; may take minutes.

    Raises
    ------
    concurrent.futures.CancelledError
        When the shelf is stopped.
    """
    if name != TABLES:
        return dict(FIGURES[name].files(shelf))
    hunt = shelf.hunt()
    rows = compare_all(shelf, hunt)
    return {"reproduction.md": write_report(shelf, hunt, rows), "reproduction.csv": write_table(rows)}
