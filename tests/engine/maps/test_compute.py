"""Maps computed in blocks of rows, and maps with their reliability."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from engine import CASES, EscapeMap, Fate, MapSpec, Plane, compute_map, compute_trust

SPECS = [
    MapSpec(CASES["III"], Plane.X_PX, 0.4, (30, 31), t_max=300.0),
    MapSpec(CASES["III"], Plane.X_Y, 0.4, (30, 32), t_max=300.0),
    MapSpec(CASES["I"], Plane.X_PX, 0.2, (31, 30), t_max=300.0),
    MapSpec(CASES["II"], Plane.X_H, (0.17, 0.4), (20, 33), t_max=300.0),
]


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.maps.compute.LARGEST_RUN", 150)


@pytest.fixture(params=SPECS, ids=lambda spec: f"{spec.potential.name}-{spec.plane.title}")
def whole(request: pytest.FixtureRequest) -> EscapeMap:
    return compute_map(request.param)


def test_map_computed_in_blocks_is_bit_identical(whole: EscapeMap, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.maps.compute.LARGEST_RUN", 150)
    in_blocks = compute_map(whole.spec)
    assert in_blocks.complete
    for name in ("fate", "escape_time", "crossings", "energy_error", "outside", "certificate"):
        np.testing.assert_array_equal(getattr(in_blocks, name), getattr(whole, name))
        assert not getattr(in_blocks, name).flags.writeable


@pytest.mark.usefixtures("small_blocks")
def test_map_computed_in_blocks_has_no_integration_state() -> None:
    assert compute_map(SPECS[0]).batch is None


@pytest.mark.usefixtures("small_blocks")
def test_each_block_gives_a_frame() -> None:
    seen: list[float] = []
    compute_map(SPECS[2], lambda frame: seen.append(frame.progress))
    assert len(seen) > 5
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


@pytest.mark.usefixtures("small_blocks")
def test_cancelled_map_holds_the_blocks_computed_so_far() -> None:
    cancel = threading.Event()
    result = compute_map(SPECS[2], lambda _frame: cancel.set(), cancel)
    assert not result.complete
    assert np.any(result.fate >= 1)
    assert np.any(result.fate == Fate.NOT_COMPUTED)


def test_map_with_trust() -> None:
    spec = MapSpec(CASES["II"], Plane.X_PX, 0.2, (40, 40), t_max=500.0)
    whole = compute_map(spec, with_trust=True)
    np.testing.assert_array_equal(whole.trust, compute_trust(compute_map(spec)).trust)
    dataset = whole.to_xarray()
    np.testing.assert_array_equal(dataset["trust"], whole.trust)
    assert "3: doubtful" in dataset["trust"].attrs["codes"]


def test_map_has_no_trust_by_default() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (8, 8), t_max=50.0))
    assert whole.trust is None
    assert "trust" not in whole.to_xarray()
