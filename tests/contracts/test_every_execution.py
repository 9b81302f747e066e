"""Results do not depend on the executor; cancelled computations end with `CancelledError`, or leave open what is not computed."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, ThreadPoolExecutor
from functools import cache
from typing import Any

import numpy as np
import pytest
import xarray as xr

from engine import (
    CASES,
    EscapeMap,
    Execution,
    Fate,
    MapSpec,
    Plane,
    Regularity,
    SweepSpec,
    Trust,
    classify_orbits,
    compute_lagrangian_descriptor,
    compute_map,
    compute_origin_fates,
    compute_regularity,
    compute_separation,
    compute_sweep,
    compute_trust,
    find_divergent_start,
    find_returns,
    find_stable_manifolds,
    integrate_orbit,
    plan_sweep,
    sample_orbits,
    sample_starts,
)
from engine.foundations.execution import SerialExecutor
from engine.propagation.limited_steps import attach_deviations, find_section_points, propagate_deviations

III, STATE = CASES["III"], (0.1, 0.0, 0.05, 0.6)
# Enough orbits for several parts in each of three threads.
SPEC = MapSpec(III, Plane.X_PX, 0.3, (72, 72), t_max=300.0)
SWEEP = SweepSpec(III, Plane.X_PX, (0.26, 0.27))


@cache
def frame() -> EscapeMap:
    return compute_map(SPEC)


def starts() -> np.ndarray:
    return sample_starts(III, 0.3, 5000, rng=1)


type Compute = Callable[[Execution], Any]

WHOLE: dict[str, Compute] = {
    "orbit": lambda execution: integrate_orbit(III, STATE, 1e5, execution=execution),
    "orbits at times": lambda execution: sample_orbits(III, [STATE], np.linspace(0.0, 30.0, 61), execution=execution),
    "separation": lambda execution: compute_separation(III, STATE, STATE, 1e3, execution=execution),
    "digits": lambda execution: integrate_orbit(III, (0.1, 0.0, 0.0, 0.3), 3e3).compute_birkhoff_digits(execution=execution),
    "divergent start": lambda execution: find_divergent_start(III, Plane.X_PX, 0.45, 0.1, 0.2, 1e3, execution=execution),
    "manifolds": lambda execution: find_stable_manifolds(III, 0.45, images=1, execution=execution),
    "origins": lambda execution: compute_origin_fates(SPEC, execution=execution),
    "sweep": lambda execution: compute_sweep(SWEEP, execution=execution),
    "plan": lambda execution: plan_sweep(SWEEP, execution=execution),
}
# Computations that return a partial result when they are cancelled, with the value of what is not computed.
PARTIAL: dict[str, tuple[Compute, str, float]] = {
    "map": (lambda execution: compute_map(SPEC, execution=execution), "fate", Fate.NOT_COMPUTED),
    "outcomes": (lambda execution: classify_orbits(III, 0.3, starts(), 300.0, execution=execution), "fate", Fate.NOT_COMPUTED),
    "regularity": (lambda execution: compute_regularity(frame(), execution=execution), "character", Regularity.NOT_JUDGED),
    "trust": (lambda execution: compute_trust(frame(), execution=execution), "trust", Trust.NOT_TESTED),
    "returns": (lambda execution: find_returns(III, 0.3, starts(), 300, 300.0, execution=execution), "fate", Fate.NOT_COMPUTED),
    "descriptors": (
        lambda execution: compute_lagrangian_descriptor(frame(), duration=3.0, execution=execution),
        "descriptor",
        np.nan,
    ),
    "section points": (lambda execution: find_section_points(III, starts(), 3, 60.0, execution=execution), "", np.nan),
    "deviations": (
        lambda execution: propagate_deviations(III, attach_deviations(starts()), 10.0, execution=execution),
        "",
        np.nan,
    ),
}
COMPUTED = {"divergent start": WHOLE["divergent start"], "manifolds": WHOLE["manifolds"]} | {
    name: compute for name, (compute, _, _) in PARTIAL.items()
}


def cancelled() -> Execution:
    cancel = threading.Event()
    cancel.set()
    return Execution(cancel=cancel)


@pytest.mark.parametrize("compute", WHOLE.values(), ids=WHOLE)
def test_a_cancelled_computation_raises(compute: Compute) -> None:
    with pytest.raises(CancelledError):
        compute(cancelled())


@pytest.mark.parametrize(("compute", "name", "missing"), PARTIAL.values(), ids=PARTIAL)
def test_a_cancelled_computation_leaves_the_rest_open(compute: Compute, name: str, missing: float) -> None:
    cancel = threading.Event()
    at_once, later, whole = (
        compute(execution)
        for execution in (cancelled(), Execution(cancel=cancel, on_progress=lambda _: cancel.set()), Execution())
    )
    assert not getattr(at_once, "complete", False)
    nothing, some, expected = (np.asarray(getattr(result, name) if name else result) for result in (at_once, later, whole))
    for found in (nothing, some):
        is_open = np.isnan(found) if np.isnan(missing) else found == missing
        assert is_open.any() or found is some
        np.testing.assert_array_equal(found[~is_open], expected[~is_open])


@pytest.mark.parametrize("compute", COMPUTED.values(), ids=COMPUTED)
def test_a_result_does_not_depend_on_the_executor(compute: Compute) -> None:
    with ThreadPoolExecutor(3) as pool:
        one, other = compute(Execution(pool)), compute(Execution(SerialExecutor()))
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other)
    else:
        xr.testing.assert_identical(one.to_xarray(), other.to_xarray())
