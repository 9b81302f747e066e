from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from typing import Any

import numpy as np
import pytest

from engine import CASES, DivergentStart, Fate, Plane, classify_orbits, find_divergent_start, integrate_orbit, start_states
from engine.execution import Execution, SerialExecutor
from engine.trajectories.nearest_divergent_start import _ring_radii

T_MAX = 2000.0
# Potential, plane, energy, x, ordinate, at different distances from the basin boundary; the third one is bounded.
STARTS = [
    ("I", Plane.X_PX, 0.2, -0.2, 0.1),
    ("II", Plane.X_Y, 0.22, 0.2, -0.1),
    ("III", Plane.X_Y, 0.5, 0.2, 0.3),
    ("II", Plane.X_PX, 0.22, 0.3, 0.05),
    ("II", Plane.X_H, (0.2, 0.4), -0.2, 0.25),
]


def find(name: str, plane: Plane, energy: Any, x: float, ordinate: float, **options: Any) -> DivergentStart | None:
    return find_divergent_start(CASES[name], plane, energy, x, ordinate, T_MAX, **options)


def find_existing(*start: Any, **options: Any) -> DivergentStart:
    divergent = find(*start, **options)
    assert divergent is not None
    return divergent


def fate_of(name: str, plane: Plane, energy: Any, x: float, ordinate: float) -> int:
    state = start_states(CASES[name], plane, energy, np.array([x]), np.array([ordinate]))[0]
    return integrate_orbit(CASES[name], state, T_MAX).fate


@pytest.fixture(scope="module", params=STARTS, ids=str)
def start(request: pytest.FixtureRequest) -> tuple[Any, ...]:
    return request.param  # type: ignore[no-any-return]


@pytest.fixture(scope="module")
def divergent(start: tuple[Any, ...]) -> DivergentStart:
    return find_existing(*start)


def test_it_escapes_through_another_channel(start: tuple[Any, ...], divergent: DivergentStart) -> None:
    assert divergent.reference_fate == fate_of(*start)
    assert divergent.fate == fate_of(*start[:3], divergent.x, divergent.ordinate)
    assert divergent.fate >= 1
    assert divergent.fate != divergent.reference_fate


def test_the_distance_is_measured_in_the_plane(start: tuple[Any, ...], divergent: DivergentStart) -> None:
    assert divergent.distance == pytest.approx(np.hypot(divergent.x - start[3], divergent.ordinate - start[4]), rel=1e-12)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.98])
def test_no_closer_start_in_the_same_direction_diverges(start: tuple[Any, ...], divergent: DivergentStart, share: float) -> None:
    x, ordinate = start[3] + share * (divergent.x - start[3]), start[4] + share * (divergent.ordinate - start[4])
    assert fate_of(*start[:3], x, ordinate) in (divergent.reference_fate, Fate.BOUNDED)


@pytest.mark.parametrize("start", [start for start in STARTS if start[1] is not Plane.X_H], ids=str, scope="module")
def test_no_start_at_half_the_distance_diverges(start: tuple[Any, ...], divergent: DivergentStart) -> None:
    name, plane, energy, x, ordinate = start
    angle = np.pi / 8 * np.arange(16)
    around = start_states(
        CASES[name],
        plane,
        energy,
        x + 0.5 * divergent.distance * np.cos(angle),
        ordinate + 0.5 * divergent.distance * np.sin(angle),
    )
    assert set(classify_orbits(CASES[name], energy, around, T_MAX).fate) <= {divergent.reference_fate, Fate.BOUNDED}


def test_it_is_close_near_a_boundary(start: tuple[Any, ...], divergent: DivergentStart) -> None:
    nearly = (start[3] + 0.98 * (divergent.x - start[3]), start[4] + 0.98 * (divergent.ordinate - start[4]))
    assert find_existing(*start[:3], *nearly).distance < 0.03 * divergent.distance


def test_a_late_escape_has_a_divergent_start_at_the_smallest_distance() -> None:
    assert find_existing("I", Plane.X_PX, 0.13, 0.3, 0.2).distance == pytest.approx(1e-13, rel=2e-3)


def test_on_x_h_it_has_the_same_energy() -> None:
    assert find_existing("II", Plane.X_H, (0.2, 0.4), -0.2, 0.25).ordinate == 0.25


def test_any_escape_diverges_from_a_bounded_start() -> None:
    assert find_existing("III", Plane.X_Y, 0.5, 0.2, 0.3).reference_fate == Fate.BOUNDED


def test_there_is_none_deep_in_an_island() -> None:
    assert find("III", Plane.X_PX, 0.26, 0.1, 0.1, furthest=0.01) is None


def test_it_is_far_away_deep_in_a_basin() -> None:
    start = ("I", Plane.X_PX, 0.2, 0.1, 0.2)
    assert find(*start, furthest=0.1) is None
    assert find_existing(*start).distance > 0.1


def test_there_is_none_below_the_escape_energy() -> None:
    assert find("II", Plane.X_PX, 0.1, 0.1, 0.1) is None


def test_mirror_images_have_equal_distances() -> None:
    one = find_existing("III", Plane.X_PX, 0.35, 0.1, 0.3)
    other = find_existing("III", Plane.X_PX, 0.35, -0.1, -0.3)
    assert one.distance == other.distance
    assert (1, 0, 3, 2)[one.reference_fate - 1] + 1 == other.reference_fate


def test_the_executor_does_not_affect_the_result() -> None:
    assert find_existing(*STARTS[0], execution=Execution(SerialExecutor())) == find_existing(*STARTS[0])


def test_a_cancelled_search_raises() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        find(*STARTS[0], execution=Execution(cancel=cancel))


@pytest.mark.parametrize(
    ("start", "options", "message"),
    [
        (("I", Plane.X_PX, 0.2, np.nan, 0.1), {}, "x=nan: must be a finite number"),
        (("I", Plane.X_PX, 0.2, 0.1, np.inf), {}, "px=inf: must be a finite number"),
        (("I", Plane.X_PX, np.nan, 0.1, 0.1), {}, "energy=nan: must be one finite number on "),
        (("I", Plane.X_PX, (0.1, 0.2), 0.1, 0.1), {}, "energy=.*: must be one finite number on "),
        (("I", Plane.X_PX, 0.2, 0.1, 0.9), {}, "px=0.9: forbidden on .* must have"),
        (("III", Plane.X_Y, 0.3, 1.2, 1.2), {}, "y=1.2: outside on .* must have"),
        (("II", Plane.X_H, (0.2, 0.4), 0.1, -0.1), {}, "h=-0.1: forbidden on .* must have"),
        (STARTS[0], {"furthest": 0.0}, "furthest=0.0: must be a finite number above 1e-13"),
        (STARTS[0], {"furthest": np.inf}, "furthest=inf: must be a finite number above 1e-13"),
    ],
)
def test_invalid_starts_and_distances_raise(start: tuple[Any, ...], options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        find(*start, **options)


def test_t_max_out_of_range_raises() -> None:
    with pytest.raises(ValueError, match="t_max=0"):
        find_divergent_start(CASES["I"], Plane.X_PX, 0.2, 0.1, 0.1, 0.0)


@pytest.mark.parametrize("directions", [2, 16])
def test_batches_of_rings_leave_no_gap(directions: int) -> None:
    batches = list(_ring_radii(1.0, directions))
    assert len(batches) > 1
    assert [batch[0] for batch in batches[1:]] == [batch[-1] for batch in batches[:-1]]
    assert batches[-1][-1] == pytest.approx(1.0)
