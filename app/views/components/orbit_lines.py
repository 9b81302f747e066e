"""Order, opacity and data columns of the lines of orbits. The slot of an orbit is its place in the list of orbits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from bokeh.models import ColumnDataSource, LinearColorMapper

from app.state.view_state import ViewState
from plots.pictures.histories import ENVELOPE_ALPHA
from plots.pictures.orbit_curves import OrbitCurves
from plots.pictures.palette import MOST_ORBITS, PALETTES

Curve = tuple[np.ndarray, np.ndarray]
"""Horizontal and vertical coordinates of the points of a curve."""

# Opacity of the orbits that are not chosen.
_FAINT_ALPHA = 0.35
# Coordinates of a curve that encloses no area, in place of a missing envelope. A list, because Bokeh sends each array in two
# messages of its own.
_NO_AREA = [np.nan]


def in_front(orbits: Sequence[OrbitCurves | None], chosen: int) -> list[tuple[int, OrbitCurves]]:
    """Return the known orbits, each with its slot. The chosen orbit is last, so it is drawn over the others."""
    known = [(slot, orbit) for slot, orbit in enumerate(orbits) if orbit is not None]
    return sorted(known, key=lambda item: item[0] == chosen)


def opacities(orbits: Sequence[tuple[int, OrbitCurves]], chosen: int) -> list[float]:
    """Return the opacity of each orbit, which is highest for the chosen orbit."""
    return [1.0 if slot == chosen else _FAINT_ALPHA for slot, _ in orbits]


def orbit_colours(state: ViewState) -> LinearColorMapper:
    """Return a mapper from the slot of an orbit to its colour. The mapper follows the palette of the view state."""
    mapper = LinearColorMapper(low=-0.5, high=MOST_ORBITS - 0.5)
    state.follow(lambda name: mapper.update(palette=list(PALETTES[name].orbits)), "palette")
    return mapper


def line_style(mapper: LinearColorMapper) -> dict[str, Any]:
    """Return the style of lines, each in the colour of its orbit."""
    return {"line_color": {"field": "slot", "transform": mapper}, "line_alpha": "alpha", "line_width": 1.5}


def band_style(mapper: LinearColorMapper) -> dict[str, Any]:
    """Return the style of envelopes, each in the colour of its orbit."""
    return {"fill_color": {"field": "slot", "transform": mapper}, "fill_alpha": "alpha", "line_color": None}


def line_source(name: str) -> ColumnDataSource:
    """Return an empty data source for the lines of orbits."""
    return ColumnDataSource({"xs": [], "ys": [], "slot": [], "alpha": []}, name=name)


def band_columns(
    orbits: Sequence[tuple[int, OrbitCurves]], outlines: Sequence[Curve], alphas: Sequence[float]
) -> dict[str, list[Any]]:
    """Return the columns of a data source with `MOST_ORBITS` envelopes, some of them without points.

    The number must not change: Bokeh uses an index of the old envelopes for the new ones, and fails if an envelope is missing.
    """
    missing = MOST_ORBITS - len(orbits)
    columns = line_columns(orbits, outlines, [ENVELOPE_ALPHA * alpha for alpha in alphas])
    padding = {"xs": _NO_AREA, "ys": _NO_AREA, "slot": 0, "alpha": 0.0}
    areas = {axis: [each if each.size else _NO_AREA for each in columns[axis]] for axis in ("xs", "ys")}
    return {name: values + [padding[name]] * missing for name, values in (columns | areas).items()}


def line_columns(
    orbits: Sequence[tuple[int, OrbitCurves]], curves: Sequence[Curve], alphas: Sequence[float]
) -> dict[str, list[Any]]:
    """Return the columns of a data source of lines."""
    return {"xs": _axis(curves, 0), "ys": _axis(curves, 1), "slot": [slot for slot, _ in orbits], "alpha": [*alphas]}


def _axis(curves: Sequence[Curve], axis: int) -> list[Any]:
    return [curve[axis].astype(np.float32) for curve in curves]
