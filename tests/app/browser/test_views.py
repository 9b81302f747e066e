"""Planes as data: the browser makes the same starts."""

from __future__ import annotations

import numpy as np
import pytest

from app.browser.views import describe_slice, describe_view
from app.state.view_state import ViewState
from engine import CASES, Plane, start_states


@pytest.mark.parametrize("plane", Plane)
def test_a_slice_describes_the_starts_of_its_plane(plane: Plane) -> None:
    slice_, point = describe_slice(plane), (0.1, 0.3)
    assert slice_ is not None
    state = dict(zip(("x", "y", "px", "py"), start_states(CASES["I"], plane, 0.4, *np.array(point)[:, None])[0], strict=True))
    expected = {**slice_["fixed"], **dict(zip(slice_["axes"], point, strict=True))}
    assert {name: state[name] for name in expected if name != "h"} == {n: v for n, v in expected.items() if n != "h"}
    assert np.sign(state[slice_["decided"]]) == slice_["sign"]
    assert set(expected) | {slice_["decided"], "h"} == {"x", "y", "px", "py", "h"}


def test_a_view_follows_the_state() -> None:
    view = describe_view(ViewState(case="III", energy=0.45, plane=Plane.X_Y, palette="safe"))
    assert (view["energy"], view["plane"], view["home"]) == (0.45, "X_Y", True)
    assert view["colours"][0] == "#009e73"
