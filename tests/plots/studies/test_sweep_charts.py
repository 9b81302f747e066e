"""Curves of a sweep join values between which no requested value is missing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, Plane, SweepSpec, compute_sweep
from engine.results import Sweep
from plots.pictures.charts import Series, Shape
from plots.pictures.palette import PAPER
from plots.studies.sweep_charts import sweep_charts

ENERGIES = (0.2, 0.22, 0.24, 0.26)


@pytest.fixture(scope="module")
def sweep() -> Sweep:
    return compute_sweep(SweepSpec(CASES["II"], Plane.X_PX, ENERGIES, (12, 12), t_max=50.0, measures=("shares", "basin_entropy")))


def with_values(sweep: Sweep, *indices: int) -> Sweep:
    """Return the sweep when only some of its values have been computed."""
    return replace(sweep, dataset=sweep.dataset.isel({sweep.dataset["share"].dims[0]: list(indices)}))


def joined(series: Series) -> list[list[float]]:
    """Return the values that each line of a series joins."""
    x = series.curve[0]
    lines = np.split(x, np.flatnonzero(np.isnan(x)))
    return [values for line in lines if len(values := line[np.isfinite(line)].tolist()) > 1]


def test_a_complete_sweep_has_one_line_for_each_curve(sweep: Sweep) -> None:
    shares, entropy = sweep_charts(sweep, PAPER)
    for series in (*(one for one in shares.series if one.label), *entropy.series):
        assert joined(series) == [list(ENERGIES)]
    assert sum(one.x.size for one in shares.series if one.shape is Shape.POINTS) == 0


def test_no_line_is_drawn_across_values_that_are_missing(sweep: Sweep) -> None:
    partial = with_values(sweep, 0, 2, 3)
    shares, entropy = sweep_charts(partial, PAPER)
    for series in (*(one for one in shares.series if one.label), *entropy.series):
        assert joined(series) == [list(ENERGIES[2:])]
    points = [one for one in shares.series if one.shape is Shape.POINTS]
    assert [one.x.tolist() for one in points] == [[0.2]] * (1 + len(partial.outcomes))
    np.testing.assert_array_equal([one.y[0] for one in points], 100.0 * partial["share"][0])
    np.testing.assert_array_equal(entropy.series[0].y[np.isfinite(entropy.series[0].x)], partial["s_b"])
