"""Maps too large to hold all their orbits at once."""

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
def small_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.maps.compute.LARGEST_RUN", 150)


@pytest.fixture(params=SPECS, ids=lambda spec: f"{spec.potential.name}-{spec.plane.value}")
def whole(request: pytest.FixtureRequest) -> EscapeMap:
    return compute_map(request.param)


def test_bands_make_the_same_map(whole: EscapeMap, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.maps.compute.LARGEST_RUN", 150)
    banded = compute_map(whole.spec)
    assert banded.complete
    for name in ("fate", "escape_time", "crossings", "energy_error", "outside", "certificate"):
        np.testing.assert_array_equal(getattr(banded, name), getattr(whole, name))
        assert not getattr(banded, name).flags.writeable


@pytest.mark.usefixtures("small_runs")
def test_bands_keep_results_only() -> None:
    assert compute_map(SPECS[0]).batch is None


@pytest.mark.usefixtures("small_runs")
def test_frames_come_band_by_band() -> None:
    seen: list[float] = []
    compute_map(SPECS[2], lambda frame: seen.append(frame.progress))
    assert len(seen) > 5
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


@pytest.mark.usefixtures("small_runs")
def test_a_cancelled_map_holds_the_bands_so_far() -> None:
    cancel = threading.Event()
    result = compute_map(SPECS[2], lambda _frame: cancel.set(), cancel)
    assert not result.complete
    assert np.any(result.fate >= 1)
    assert np.any(result.fate == Fate.NOT_COMPUTED)


def test_a_map_can_be_asked_for_with_its_trust_mask() -> None:
    spec = MapSpec(CASES["II"], Plane.X_PX, 0.2, (40, 40), t_max=500.0)
    whole = compute_map(spec, with_trust=True)
    np.testing.assert_array_equal(whole.trust, compute_trust(compute_map(spec)).trust)
    dataset = whole.to_xarray()
    np.testing.assert_array_equal(dataset["trust"], whole.trust)
    assert "3: doubtful" in dataset["trust"].attrs["codes"]


def test_a_map_has_no_trust_mask_unless_it_is_asked_for() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (8, 8), t_max=50.0))
    assert whole.trust is None
    assert "trust" not in whole.to_xarray()
