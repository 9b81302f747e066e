"""The codes of pixels rise with their descriptors, and the legend has the ends of the scale."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, Fate, MapSpec, Plane, Potential, compute_lagrangian_descriptor, compute_map
from engine.maps.analyses.descriptors import DEFAULT_DURATION
from plots.layers.descriptors import DESCRIPTORS
from plots.layers.picture import ShownMap
from plots.layers.table import map_legend
from plots.pictures.image_columns import FIRST_CLASS
from plots.pictures.palette import OUTCOMES, PAPER

FRAME = MapSpec(CASES["II"], Plane.X_Y, 0.24, (20, 20), t_max=20.0)


def test_codes_rise_with_the_descriptor_and_other_pixels_have_those_of_their_fate() -> None:
    frame = compute_map(FRAME)
    found = compute_lagrangian_descriptor(frame)
    assert DESCRIPTORS.pixels is not None
    codes = DESCRIPTORS.pixels.codes(found, frame)
    assert len(DESCRIPTORS.pixels.colours(PAPER)) <= 256
    order = np.argsort(found.descriptor[frame.interior])
    assert np.all(np.diff(codes[frame.interior][order].astype(int)) >= 0)
    assert codes[frame.interior].min() == FIRST_CLASS
    for fate in (Fate.FORBIDDEN, Fate.OUTSIDE):
        assert set(codes[frame.fate == fate]) == {list(OUTCOMES).index(fate)}


def test_the_duration_counts_in_units_of_time_of_the_well() -> None:
    slow = Potential("slow", tuple((i, j, 0.25 * c) for i, j, c in CASES["II"].terms))
    assert slow.units.time == pytest.approx(2.0)
    job = DESCRIPTORS.job(MapSpec(slow, Plane.X_Y, 0.06, (8, 8), t_max=40.0), {})
    assert job is not None
    assert dict(job.options)["duration"] == pytest.approx(2.0 * DEFAULT_DURATION)


def test_the_legend_has_the_scale_of_the_result() -> None:
    frame = compute_map(FRAME)
    found = compute_lagrangian_descriptor(frame)
    assert map_legend("descriptors", ShownMap.of(frame, PAPER, {})).scale is None
    scale = map_legend("descriptors", ShownMap.of(frame, PAPER, {"descriptor": found})).scale
    assert scale is not None
    known = found.descriptor[frame.interior]
    assert known.min() <= scale.low < scale.high <= 1.01 * known.max()
