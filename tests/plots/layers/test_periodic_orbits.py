"""The layer marks periodic orbits by rings and crosses at their returns, and draws families as curves on slices along h."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, POTENTIALS, Coordinate, Execution, MapSpec, Plane, Slice, Stability, read_section
from engine.jobs.job import run_job
from engine.results import PeriodicOrbits, SymmetricFamilies
from plots.layers.periodic_orbits import PERIODIC_ORBITS, periodic_strokes
from plots.pictures.palette import PAPER
from plots.pictures.periodic_marks import STABILITY_COLOURS

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.3, (20, 20), t_max=100.0)
ALONG_H = MapSpec(CASES["III"], Plane.X_H, (0.3, 0.6), (20, 20), (-0.8, 0.8, 0.3, 0.6), t_max=100.0)


@pytest.fixture(scope="module")
def found() -> PeriodicOrbits:
    result: PeriodicOrbits = run_job(PERIODIC_ORBITS.job(SPEC, {"periodic": 1}), Execution(), {})
    return result


@pytest.fixture(scope="module")
def families() -> SymmetricFamilies:
    result: SymmetricFamilies = run_job(PERIODIC_ORBITS.job(ALONG_H, {"periodic": 2}), Execution(), {})
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


def test_families_are_curves_in_the_colours_of_their_stability(families: SymmetricFamilies) -> None:
    assert families.spec.window == ALONG_H.window
    strokes = periodic_strokes(families)
    for stroke in strokes:
        (kind,) = [kind for kind, colour in STABILITY_COLOURS.items() if colour == stroke.colour(PAPER)]
        points = families.points[families.stability == kind]
        drawn = np.concatenate(stroke.lines)
        assert all(np.any(np.all(drawn == point, axis=1)) for point in points)
        # What is drawn besides these points is halfway between two points of a curve.
        others = [point for point in drawn if not np.any(np.all(points == point, axis=1))]
        middles = 0.5 * (families.points[1:] + families.points[:-1])
        assert all(np.any(np.all(middles == point, axis=1)) for point in others)
    assert strokes[-1].width > max(stroke.width for stroke in strokes[:-1])


def test_parts_of_a_curve_with_other_stability_meet(families: SymmetricFamilies) -> None:
    stable, *others = periodic_strokes(families)[::-1]
    # The straight orbit x = 0 loses its stability at this energy, where another family branches off.
    (line,) = [line for line in stable.lines if np.count_nonzero(np.abs(line[:, 0]) < 1e-9) > 2]
    end = line[np.argmax(line[:, 1])]
    assert end == pytest.approx((0.0, 0.58168), abs=0.02)
    ends_of_others = np.array([line[k] for stroke in others for line in stroke.lines for k in (0, -1)])
    assert np.abs(ends_of_others - end).max(axis=1).min() == 0.0


def test_curves_are_not_joined_with_each_other(families: SymmetricFamilies) -> None:
    window, (columns, rows) = ALONG_H.find_window(), families.spec.resolution
    cell = np.array([window.width / columns, window.height / rows])
    for stroke in periodic_strokes(families):
        for line in stroke.lines:
            assert np.all(np.abs(np.diff(line, axis=0)) <= cell * (1.0 + 1e-9))


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
        (ALONG_H, ""),
        (replace(ALONG_H, section=read_section("x = 0")), "all starts are on the section"),
        (MapSpec(POTENTIALS["HH"], Plane.X_H, (0.1, 0.2)), "symmetry with reversed time"),
        (MapSpec(POTENTIALS["HH"], Slice(Coordinate.Y, Coordinate.H, Coordinate.PX), (0.1, 0.2), section="x = 0"), ""),
    ],
)
def test_maps_without_the_section_are_refused(spec: MapSpec, reason: str) -> None:
    refusal = PERIODIC_ORBITS.refusal(spec)
    assert reason in refusal
    assert bool(refusal) == bool(reason)
