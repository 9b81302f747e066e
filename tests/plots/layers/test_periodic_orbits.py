"""The layer marks stable periodic orbits by rings, unstable ones by crosses, at their returns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, Execution, MapSpec, Plane, Stability
from engine.jobs.job import run_job
from engine.results import PeriodicOrbits
from plots.layers.periodic_orbits import PERIODIC_ORBITS, periodic_strokes
from plots.pictures.palette import PAPER
from plots.pictures.periodic_marks import STABILITY_COLOURS

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.3, (20, 20), t_max=100.0)


@pytest.fixture(scope="module")
def found() -> PeriodicOrbits:
    result: PeriodicOrbits = run_job(PERIODIC_ORBITS.job(SPEC, {"periodic": 1}), Execution(), {})
    return result


def test_every_return_has_a_mark_in_the_colour_of_its_stability(found: PeriodicOrbits) -> None:
    assert found.most_returns == 1
    marks = [len(stroke.lines) for stroke in periodic_strokes(found)]
    stable = np.count_nonzero(found.stability == Stability.STABLE)
    assert sum(marks) == stable + 2 * (len(found.orbit) - stable)
    for stroke in periodic_strokes(found):
        (kind,) = [kind for kind, colour in STABILITY_COLOURS.items() if colour == stroke.colour(PAPER)]
        points = found.points[found.stability == kind]
        lines_of_mark = 1 if kind is Stability.STABLE else 2
        centres = [0.5 * (line.min(axis=0) + line.max(axis=0)) for line in stroke.lines[::lines_of_mark]]
        assert len(stroke.lines) == lines_of_mark * len(points)
        np.testing.assert_allclose(centres, points, atol=1e-12)


def test_the_legend_names_the_kinds_that_occur(found: PeriodicOrbits) -> None:
    assert PERIODIC_ORBITS.over is not None
    labels = [entry.label for entry in PERIODIC_ORBITS.over.legend(found, PAPER)]
    assert labels == ["periodic, stable", "periodic, unstable"]


@pytest.mark.parametrize(
    ("spec", "reason"),
    [
        (SPEC, ""),
        (replace(SPEC, plane=Plane.X_Y), "on the slice of the surface of section only; (x, y) is another slice"),
        (replace(SPEC, backward=True), "forward in time only"),
    ],
)
def test_maps_without_the_section_are_refused(spec: MapSpec, reason: str) -> None:
    refusal = PERIODIC_ORBITS.refusal(spec)
    assert reason in refusal
    assert bool(refusal) == bool(reason)
