"""Cancelled computations end with `CancelledError`, or return what is computed of a map."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import CancelledError
from typing import Any

import numpy as np
import pytest

from engine import (
    CASES,
    Execution,
    MapSpec,
    Plane,
    SweepSpec,
    compute_origin_fates,
    compute_separation,
    compute_sweep,
    find_divergent_start,
    find_stable_manifolds,
    integrate_orbit,
    plan_sweep,
    sample_orbits,
)

III, STATE = CASES["III"], (0.1, 0.0, 0.05, 0.6)
SWEEP = SweepSpec(III, Plane.X_PX, (0.26, 0.27))

COMPUTATIONS: dict[str, Callable[[Execution], Any]] = {
    "orbit": lambda execution: integrate_orbit(III, STATE, 1e5, execution=execution),
    "orbits at times": lambda execution: sample_orbits(III, [STATE], np.linspace(0.0, 30.0, 61), execution=execution),
    "separation": lambda execution: compute_separation(III, STATE, STATE, 1e3, execution=execution),
    "digits": lambda execution: integrate_orbit(III, (0.1, 0.0, 0.0, 0.3), 3e3).compute_birkhoff_digits(execution=execution),
    "divergent start": lambda execution: find_divergent_start(III, Plane.X_PX, 0.45, 0.1, 0.2, 1e3, execution=execution),
    "manifolds": lambda execution: find_stable_manifolds(III, 0.45, execution=execution),
    "origins": lambda execution: compute_origin_fates(MapSpec(III, Plane.X_PX, 0.26), execution=execution),
    "sweep": lambda execution: compute_sweep(SWEEP, execution=execution),
    "plan": lambda execution: plan_sweep(SWEEP, execution=execution),
}


@pytest.mark.parametrize("compute", COMPUTATIONS.values(), ids=COMPUTATIONS)
def test_a_cancelled_computation_raises(compute: Callable[[Execution], Any]) -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        compute(Execution(cancel=cancel))
