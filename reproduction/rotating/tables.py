"""Print a table for each system, with numbers of its maps for the comparison with papers.

Run: python -m reproduction.rotating.tables
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType

import numpy as np

from engine import EscapeMap, Fate, compute_map
from reproduction.notation import write_rows
from reproduction.rotating.map_measures import (
    boundary_exponent,
    bounded_share_beside,
    end_times,
    outcome_share,
    share_next_to_islands,
)
from reproduction.rotating.paper_maps import PAPER_MAPS

Columns = Mapping[str, tuple[Callable[[EscapeMap], float], str]]
"""Measure and format of each column, by heading."""


def _share(*codes: int) -> tuple[Callable[[EscapeMap], float], str]:
    return lambda frame: outcome_share(frame, *codes), ".1f"


_STAYS = {"stays": _share(Fate.BOUNDED)}
_EXPONENT = {"exponent": (boundary_exponent, ".2f")}
_TIMES: Columns = {
    "time inside": (lambda frame: end_times(frame).inside, ".1f"),
    "time at boundaries": (lambda frame: end_times(frame).at_boundary, ".1f"),
}

COLUMNS: Mapping[str, Columns] = MappingProxyType(
    {
        "Earth–Moon system": {
            "L2": _share(1),
            "L1": _share(2),
            "Moon": _share(3),
            **_STAYS,
            "ends next to islands": (partial(share_next_to_islands, late=False), ".1f"),
            "late ends next to islands": (partial(share_next_to_islands, late=True), ".1f"),
        },
        "Copenhagen problem": {
            "body 1": _share(1),
            "body 2": _share(2),
            "collides": _share(1, 2),
            "escapes": _share(3),
            **_STAYS,
        },
        "Star cluster": {
            "exit 1": _share(1),
            "exit 2": _share(2),
            **_STAYS,
            "stays, x < 0": (partial(bounded_share_beside, sign=-1), ".1f"),
            "stays, x > 0": (partial(bounded_share_beside, sign=1), ".1f"),
            **_EXPONENT,
            **_TIMES,
        },
        "Four hills": {
            "right": _share(1),
            "top": _share(2),
            "left": _share(3),
            "bottom": _share(4),
            **_STAYS,
            **_EXPONENT,
            **_TIMES,
            "last end": (lambda frame: float(np.nanmax(frame.escape_time)), ".1f"),
        },
    }
)
"""Columns of the table of each system."""


def make_table(system: str) -> str:
    """Return the Markdown table of a system, a key of `PAPER_MAPS`. This takes up to a few minutes."""
    columns = COLUMNS[system]
    frames = [(paper_map.name, compute_map(paper_map.spec)) for paper_map in PAPER_MAPS[system]]
    rows = [[name, *(_text(measure(frame), form) for measure, form in columns.values())] for name, frame in frames]
    return write_rows([system, *columns], rows)


def _text(value: float, form: str) -> str:
    return f"{value:{form}}" if np.isfinite(value) else "none"


if __name__ == "__main__":
    for system in PAPER_MAPS:
        sys.stdout.write(f"{make_table(system)}\n\n")
