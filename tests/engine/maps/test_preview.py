"""A preview agrees with the map on early escapes, and leaves all other orbits undecided."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from engine import CASES, Fate, MapSpec, Plane, compute_map
from engine.service import PREVIEW_SIDE, PREVIEW_TIME, compute_preview, preview_spec


@pytest.mark.parametrize("case", list(CASES))
def test_early_escapes_are_the_same_as_in_the_map(case: str) -> None:
    spec = preview_spec(MapSpec(CASES[case], Plane.X_PX, 0.3))
    preview = compute_preview(spec)
    whole = compute_map(spec)
    escaped = whole.fate >= 1
    np.testing.assert_array_equal(preview.fate[escaped], whole.fate[escaped])
    np.testing.assert_array_equal(preview.escape_time[escaped], whole.escape_time[escaped])


def test_orbits_still_inside_are_undecided() -> None:
    preview = compute_preview(preview_spec(MapSpec(CASES["III"], Plane.X_PX, 0.27)))
    assert not np.any(preview.fate == Fate.BOUNDED)
    assert np.any(preview.fate == Fate.NOT_COMPUTED)
    assert not preview.complete


def test_preview_is_small_and_short() -> None:
    spec = preview_spec(MapSpec(CASES["I"], Plane.X_Y, 0.2, (900, 40), t_max=1e5))
    assert spec.resolution == (PREVIEW_SIDE, 40)
    assert spec.t_max == PREVIEW_TIME


def test_cancelled_preview_has_no_escapes() -> None:
    cancel = threading.Event()
    cancel.set()
    preview = compute_preview(preview_spec(MapSpec(CASES["I"], Plane.X_PX, 0.3)), cancel=cancel)
    assert not np.any(preview.fate >= 1)
