"""Maps computed in blocks of rows, and maps with their reliability."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from engine import CASES, Fate, MapSpec, Plane, compute_map

SPECS = [
    MapSpec(CASES["III"], Plane.X_PX, 0.4, (30, 31), t_max=300.0),
    MapSpec(CASES["II"], Plane.X_H, (0.17, 0.4), (20, 33), t_max=300.0),
]


@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: spec.plane.title)
def test_map_computed_in_blocks_is_bit_identical(spec: MapSpec, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = compute_map(spec)
    monkeypatch.setattr("engine.maps.compute.LARGEST_RUN", 150)
    monkeypatch.setattr("engine.maps.stages.LONGEST_PAUSE", 0.0)
    shares: list[float] = []
    in_blocks = compute_map(spec, lambda frame: shares.append(frame.progress))
    assert in_blocks.complete
    for name in ("fate", "escape_time", "crossings", "energy_error", "outside", "evidence"):
        np.testing.assert_array_equal(getattr(in_blocks, name), getattr(whole, name))
    assert len(shares) >= 5
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_cancelled_map_holds_the_blocks_computed_so_far(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.maps.compute.LARGEST_RUN", 150)
    cancel = threading.Event()
    result = compute_map(SPECS[0], lambda _frame: cancel.set(), cancel)
    assert not result.complete
    assert np.any(result.fate >= 1)
    assert np.any(result.fate == Fate.NOT_COMPUTED)
