"""Lines of the chosen orbits, each in its colour: their order, their opacity and their columns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from bokeh.models import ColumnDataSource, LinearColorMapper

from plots.orbit_curves import OrbitCurves

_OTHERS_ALPHA = 0.35


def in_front(drawings: Sequence[OrbitCurves | None], chosen: int) -> list[tuple[int, OrbitCurves]]:
    """The numbers of the orbits that are known, and their curves; the chosen one is last, over the others."""
    known = [(slot, drawing) for slot, drawing in enumerate(drawings) if drawing is not None]
    return sorted(known, key=lambda item: item[0] == chosen)


def opacities(drawings: Sequence[tuple[int, OrbitCurves]], chosen: int) -> list[float]:
    """The opacity of each orbit: the chosen one stands out."""
    return [1.0 if slot == chosen else _OTHERS_ALPHA for slot, _ in drawings]


def line_style(mapper: LinearColorMapper) -> dict[str, Any]:
    """Style of the lines of orbits, each in its colour."""
    return {"line_color": {"field": "slot", "transform": mapper}, "line_alpha": "alpha", "line_width": 1.5}


def lines(name: str) -> ColumnDataSource:
    """A source of lines of orbits."""
    return ColumnDataSource({"xs": [], "ys": [], "slot": [], "alpha": []}, name=name)


def line_columns(
    drawings: Sequence[tuple[int, OrbitCurves]], curves: Sequence[tuple[np.ndarray, np.ndarray]], alphas: Sequence[float]
) -> dict[str, list[object]]:
    """The columns of a source of lines."""
    slots: list[object] = [slot for slot, _ in drawings]
    xs, ys = ([line[axis].astype(np.float32) for line in curves] for axis in (0, 1))
    return {"xs": [*xs], "ys": [*ys], "slot": slots, "alpha": [*alphas]}
