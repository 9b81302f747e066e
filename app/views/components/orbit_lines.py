"""Lines of the chosen orbits, each in its colour: their order, their opacity and their columns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from bokeh.models import ColumnDataSource, LinearColorMapper

from plots.pictures.histories import ENVELOPE_ALPHA
from plots.pictures.orbit_curves import OrbitCurves
from plots.pictures.palette import MOST_ORBITS

Curve = tuple[np.ndarray, np.ndarray]
"""Horizontal and vertical coordinates."""

_OTHERS_ALPHA = 0.35
_NO_AREA = np.full(1, np.nan), np.full(1, np.nan)


def in_front(drawings: Sequence[OrbitCurves | None], chosen: int) -> list[tuple[int, OrbitCurves]]:
    """The numbers of the orbits that are known, and their curves; the chosen orbit is last and lies over the others."""
    known = [(slot, drawing) for slot, drawing in enumerate(drawings) if drawing is not None]
    return sorted(known, key=lambda item: item[0] == chosen)


def opacities(drawings: Sequence[tuple[int, OrbitCurves]], chosen: int) -> list[float]:
    """The opacity of each orbit: the chosen orbit is the most visible."""
    return [1.0 if slot == chosen else _OTHERS_ALPHA for slot, _ in drawings]


def line_style(mapper: LinearColorMapper) -> dict[str, Any]:
    """Style of the lines of orbits, each in its colour."""
    return {"line_color": {"field": "slot", "transform": mapper}, "line_alpha": "alpha", "line_width": 1.5}


def band_style(mapper: LinearColorMapper) -> dict[str, Any]:
    """Style of the envelopes of orbits, each in its colour."""
    return {"fill_color": {"field": "slot", "transform": mapper}, "fill_alpha": "alpha", "line_color": None}


def lines(name: str) -> ColumnDataSource:
    """A source of lines of orbits."""
    return ColumnDataSource({"xs": [], "ys": [], "slot": [], "alpha": []}, name=name)


def band_columns(
    drawings: Sequence[tuple[int, OrbitCurves]], outlines: Sequence[Curve], alphas: Sequence[float]
) -> dict[str, list[Any]]:
    """Columns of a source of envelopes. Their number is always the largest number of orbits; some have no points.

    Bokeh determines what is in view before it has indexed new data, and fails if an envelope has been removed.
    """
    missing = MOST_ORBITS - len(drawings)
    shown = [outline if outline[0].size else _NO_AREA for outline in outlines] + [_NO_AREA] * missing
    columns = line_columns(drawings, shown, [ENVELOPE_ALPHA * alpha for alpha in alphas])
    return columns | {"slot": columns["slot"] + [0] * missing, "alpha": columns["alpha"] + [0.0] * missing}


def line_columns(
    drawings: Sequence[tuple[int, OrbitCurves]], curves: Sequence[Curve], alphas: Sequence[float]
) -> dict[str, list[Any]]:
    """The columns of a source of lines."""
    return {"xs": _axis(curves, 0), "ys": _axis(curves, 1), "slot": [slot for slot, _ in drawings], "alpha": [*alphas]}


def _axis(curves: Sequence[Curve], axis: int) -> list[Any]:
    return [curve[axis].astype(np.float32) for curve in curves]
