"""Plans of sweeps estimate starts, bytes and time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, SweepSpec, compute_sweep, plan_sweep
from engine.sweeps.plan import SweepPlan

SPEC = SweepSpec(CASES["III"], Plane.X_PX, (0.4, 0.3, 0.5), (12, 10), t_max=300.0)


def test_plan_counts_starts_and_bytes() -> None:
    plan = plan_sweep(SPEC, cores=3)
    assert plan.orbits == 3 * 12 * 10
    assert plan.cores == 3
    assert plan.bytes == compute_sweep(SPEC).dataset.drop_vars(("h", "x", "px")).nbytes


def test_time_scales_with_pixels_and_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.sweeps.plan.measure_seconds", lambda spec, _execution: 0.5 + 1e-4 * np.prod(spec.resolution))
    one = plan_sweep(replace(SPEC, resolution=(1000, 1000)), cores=1)
    many = plan_sweep(replace(SPEC, resolution=(1000, 1000)), cores=10)
    assert one.seconds == pytest.approx(3 * 100.5)
    assert many.seconds == pytest.approx(one.seconds / 10)


def test_plan_uses_the_midpoints_of_twelve_intervals(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: set[float] = set()

    def measured(spec: MapSpec, _execution: object) -> float:
        seen.add(float(spec.energy))  # type: ignore[arg-type]
        return 1.0

    monkeypatch.setattr("engine.sweeps.plan.measure_seconds", measured)
    plan_sweep(replace(SPEC, values=tuple(np.linspace(0.0, 0.24, 241))))
    assert sorted(seen) == pytest.approx(np.arange(0.01, 0.24, 0.02), abs=0.001)


def test_the_description_of_a_plan_states_its_costs() -> None:
    text = SweepPlan(10**9, 7200.0, 23 * 10**9, 16).describe()
    assert text == "1e+09 orbits: about 2 hours on 16 cores (32 core hours), at most 23 GB"
