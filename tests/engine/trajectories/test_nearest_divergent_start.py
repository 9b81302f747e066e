from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from typing import Any

import numpy as np
import pytest

from engine import CASES, Fate, Plane, Twin, classify_orbits, find_twin, integrate_orbit, start_states
from engine.execution import SerialExecutor

T_MAX = 2000.0
# potential, plane, energy, x, ordinate: of different depth in their basins, the third one bounded.
STARTS = [
    ("I", Plane.X_PX, 0.2, -0.2, 0.1),
    ("II", Plane.X_Y, 0.22, 0.2, -0.1),
    ("III", Plane.X_Y, 0.5, 0.2, 0.3),
    ("II", Plane.X_PX, 0.22, 0.3, 0.05),
    ("II", Plane.X_H, (0.2, 0.4), -0.2, 0.25),
]


def twin_of(name: str, plane: Plane, energy: Any, x: float, ordinate: float, **options: Any) -> Twin | None:
    return find_twin(CASES[name], plane, energy, x, ordinate, T_MAX, **options)


def found(*start: Any, **options: Any) -> Twin:
    twin = twin_of(*start, **options)
    assert twin is not None
    return twin


def fate_of(name: str, plane: Plane, energy: Any, x: float, ordinate: float) -> int:
    state = start_states(CASES[name], plane, energy, np.array([x]), np.array([ordinate]))[0]
    return integrate_orbit(CASES[name], state, T_MAX).fate


@pytest.fixture(scope="module", params=STARTS, ids=str)
def start(request: pytest.FixtureRequest) -> tuple[Any, ...]:
    return request.param  # type: ignore[no-any-return]


@pytest.fixture(scope="module")
def twin(start: tuple[Any, ...]) -> Twin:
    return found(*start)


def test_the_twin_leaves_elsewhere(start: tuple[Any, ...], twin: Twin) -> None:
    assert twin.first_fate == fate_of(*start)
    assert twin.fate == fate_of(*start[:3], twin.x, twin.ordinate)
    assert twin.fate >= 1
    assert twin.fate != twin.first_fate


def test_the_distance_is_that_in_the_plane(start: tuple[Any, ...], twin: Twin) -> None:
    assert twin.distance == pytest.approx(np.hypot(twin.x - start[3], twin.ordinate - start[4]), rel=1e-12)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.98])
def test_nothing_nearer_on_the_way_to_the_twin_leaves_elsewhere(start: tuple[Any, ...], twin: Twin, share: float) -> None:
    x, ordinate = start[3] + share * (twin.x - start[3]), start[4] + share * (twin.ordinate - start[4])
    assert fate_of(*start[:3], x, ordinate) in (twin.first_fate, Fate.BOUNDED)


@pytest.mark.parametrize("start", [start for start in STARTS if start[1] is not Plane.X_H], ids=str, scope="module")
def test_at_half_the_distance_no_direction_leaves_elsewhere(start: tuple[Any, ...], twin: Twin) -> None:
    name, plane, energy, x, ordinate = start
    angle = np.pi / 8 * np.arange(16)
    around = start_states(
        CASES[name], plane, energy, x + 0.5 * twin.distance * np.cos(angle), ordinate + 0.5 * twin.distance * np.sin(angle)
    )
    assert set(classify_orbits(CASES[name], energy, around, T_MAX).fate) <= {twin.first_fate, Fate.BOUNDED}


def test_near_a_boundary_the_twin_is_near(start: tuple[Any, ...], twin: Twin) -> None:
    nearly = (start[3] + 0.98 * (twin.x - start[3]), start[4] + 0.98 * (twin.ordinate - start[4]))
    assert found(*start[:3], *nearly).distance < 0.03 * twin.distance


def test_an_orbit_that_leaves_late_has_its_twin_at_the_end_of_double_precision() -> None:
    assert found("I", Plane.X_PX, 0.13, 0.3, 0.2).distance == pytest.approx(1e-13, rel=2e-3)


def test_on_x_h_the_twin_has_the_same_energy() -> None:
    assert found("II", Plane.X_H, (0.2, 0.4), -0.2, 0.25).ordinate == 0.25


def test_any_escape_is_a_twin_of_a_bounded_start() -> None:
    assert found("III", Plane.X_Y, 0.5, 0.2, 0.3).first_fate == Fate.BOUNDED


def test_deep_in_an_island_there_is_none() -> None:
    assert twin_of("III", Plane.X_PX, 0.26, 0.1, 0.1, furthest=0.01) is None


def test_deep_in_a_basin_it_is_found_only_far_away() -> None:
    start = ("I", Plane.X_PX, 0.2, 0.1, 0.2)
    assert twin_of(*start, furthest=0.1) is None
    assert found(*start).distance > 0.1


def test_below_the_escape_energy_there_is_none() -> None:
    assert twin_of("II", Plane.X_PX, 0.1, 0.1, 0.1) is None


def test_mirror_images_have_their_twins_equally_far() -> None:
    one = found("III", Plane.X_PX, 0.35, 0.1, 0.3)
    other = found("III", Plane.X_PX, 0.35, -0.1, -0.3)
    assert one.distance == other.distance
    assert (1, 0, 3, 2)[one.first_fate - 1] + 1 == other.first_fate


def test_an_executor_makes_no_difference() -> None:
    assert found(*STARTS[0], executor=SerialExecutor()) == found(*STARTS[0])


def test_when_cancelled_it_says_so() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        twin_of(*STARTS[0], cancel=cancel)


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
def test_what_has_no_twin_is_refused(start: tuple[Any, ...], options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        twin_of(*start, **options)


def test_a_time_out_of_range_is_refused() -> None:
    with pytest.raises(ValueError, match="t_max=0"):
        find_twin(CASES["I"], Plane.X_PX, 0.2, 0.1, 0.1, 0.0)
