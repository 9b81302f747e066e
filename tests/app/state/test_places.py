"""A state has the place on a slice from which it starts."""

from __future__ import annotations

import numpy as np
import pytest

from app.state.places import find_place
from engine import CASES, Coordinate, Direction, Plane, Slice, start_states

C = Coordinate
SLICES = [
    (Plane.X_PX, (0.1, 0.2)),
    (Plane.X_Y, (0.1, -0.2)),
    (Plane.Y_PY, (0.1, 0.2)),
    (Plane.X_H, (0.1, 0.25)),
    (Plane.TANGENTIAL, (0.1, 0.2)),
    (Slice(C.X, C.THETA, fixed=((C.Y, 0.05),)), (0.1, 2.5)),
    (Slice(C.X, C.BETA, fixed=((C.Y, 0.05),)), (0.1, -0.4)),
    (Slice(C.X, C.PX, C.PY, -1), (0.1, 0.2)),
    (Slice(Direction("u", x=0.6, y=0.8), C.PX), (0.2, 0.1)),
]


@pytest.mark.parametrize(("plane", "place"), SLICES, ids=[plane.key for plane, _ in SLICES])
def test_the_place_of_a_start_is_found_again(plane: Slice, place: tuple[float, float]) -> None:
    [state] = start_states(CASES["II"], plane, 0.2, *np.array(place)[:, None])
    assert find_place(plane, CASES["II"], 0.2, tuple(state)) == pytest.approx(place, rel=1e-12)


def test_a_state_of_another_momentum_energy_or_position_has_no_place() -> None:
    [state] = start_states(CASES["II"], Plane.X_PX, 0.2, np.array([0.1]), np.array([0.2]))
    assert find_place(Plane.X_Y, CASES["II"], 0.2, tuple(state)) is None
    assert find_place(Plane.X_PX, CASES["II"], 0.21, tuple(state)) is None
    assert find_place(Plane.Y_PY, CASES["II"], 0.2, tuple(state)) is None
    assert find_place(Plane.X_PX, CASES["II"], 0.2, (np.nan,) * 4) is None
