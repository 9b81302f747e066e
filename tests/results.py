"""Compute a small result of each kind once."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from engine import (
    CASES,
    MapSpec,
    Plane,
    Result,
    SweepSpec,
    classify_orbits,
    compute_basin_entropy,
    compute_lagrangian_descriptor,
    compute_map,
    compute_origin_fates,
    compute_regularity,
    compute_returns,
    compute_separation,
    compute_statistics,
    compute_sweep,
    compute_trust,
    compute_uncertainty_exponent,
    compute_wada_test,
    continue_family,
    find_divergent_start,
    find_lyapunov_orbits,
    find_periodic_orbit,
    find_periodic_orbits,
    find_returns,
    find_stable_manifolds,
    find_symmetric_families,
    find_where,
    fit_decay_laws,
    integrate_orbit,
    judge_orbit,
    parse_formula,
    review_potential,
    sample_orbits,
    sample_starts,
)
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits

POTENTIAL, ENERGY, STATE = CASES["III"], 0.36, (0.1, 0.0, 0.05, 0.6)
SPEC = MapSpec(POTENTIAL, Plane.X_PX, ENERGY, (40, 30), t_max=200.0)

_MAKERS: dict[str, Callable[[], Result | None]] = {
    "potential": lambda: POTENTIAL,
    "review": lambda: review_potential(POTENTIAL),
    "review of a degenerate potential": lambda: review_potential(parse_formula("x⁴ + y⁴")),
    "review of a curve of critical points": lambda: review_potential(parse_formula("(x² + y² − 1)²")),
    "map": lambda: compute_map(SPEC),
    "regularity": lambda: compute_regularity(compute_map(SPEC)),
    "trust": lambda: compute_trust(compute_map(SPEC)),
    "origins": lambda: compute_origin_fates(SPEC),
    "descriptors": lambda: compute_lagrangian_descriptor(compute_map(SPEC), duration=2.0),
    "orbit": lambda: integrate_orbit(POTENTIAL, STATE, t_max=50.0),
    "verdict": lambda: judge_orbit(integrate_orbit(POTENTIAL, STATE, t_max=50.0)),
    "orbits": lambda: sample_orbits(POTENTIAL, sample_starts(POTENTIAL, ENERGY, 12, rng=1), np.linspace(0.0, 30.0, 301)),
    "outcomes": lambda: classify_orbits(POTENTIAL, ENERGY, sample_starts(POTENTIAL, ENERGY, 50, rng=0), t_max=20.0),
    "Lyapunov orbit": lambda: find_lyapunov_orbits(POTENTIAL, ENERGY)[1],
    "manifolds": lambda: find_stable_manifolds(POTENTIAL, ENERGY, images=1),
    "separation": lambda: compute_separation(POTENTIAL, STATE, (0.1, 0.0, 0.05, 0.60001), 20.0),
    "digits": lambda: compute_birkhoff_digits(POTENTIAL, (0.1, 0.0, 0.05, 0.3), 2e3),
    "divergent start": lambda: find_divergent_start(POTENTIAL, Plane.X_PX, ENERGY, 0.1, 0.0, 50.0),
    "statistics": lambda: compute_statistics(compute_map(SPEC)),
    "decay laws": lambda: fit_decay_laws(compute_map(SPEC)),
    "entropy": lambda: compute_basin_entropy(compute_map(SPEC)),
    "Wada test": lambda: compute_wada_test(compute_map(SPEC)),
    "exponent": lambda: compute_uncertainty_exponent(SPEC, pairs=20, separations=8, work=1e6, rng=0),
    "returns": lambda: compute_returns(replace(SPEC, resolution=(6, 5)), returns=4),
    "returns of orbits": lambda: find_returns(
        POTENTIAL, ENERGY, sample_starts(POTENTIAL, ENERGY, 9, rng=0), returns=4, section="x = 0"
    ),
    "periodic orbit": lambda: find_periodic_orbit(POTENTIAL, (0.0, 0.0, 0.1, 0.8), returns=2),
    "periodic orbits": lambda: find_periodic_orbits(replace(SPEC, resolution=(8, 8)), returns=1),
    "family": lambda: continue_family(find_periodic_orbit(POTENTIAL, (0.0, 0.0, 0.0, 0.8), returns=1), 0.4),
    "symmetric families": lambda: find_symmetric_families(MapSpec(POTENTIAL, Plane.X_H, (0.2, 0.4), (16, 16), t_max=50.0)),
    "family along a parameter": lambda: continue_family(
        find_periodic_orbit(POTENTIAL, (0.0, 0.0, 0.0, 0.8), returns=1), 1.1, along="epsilon"
    ),
    "threshold": lambda: find_where(SweepSpec(POTENTIAL, Plane.X_PX, (0.3, 0.36), (20, 20), t_max=100.0), "share_bounded", 0.5),
    "sweep": lambda: compute_sweep(SweepSpec(POTENTIAL, Plane.X_PX, (0.3, 0.36), (20, 20), t_max=100.0, measures="shares")),
}

RESULTS = tuple(_MAKERS)
"""Names of the results."""


@functools.cache
def result_of(name: str) -> Result:
    """Return the result with a name."""
    result = _MAKERS[name]()
    assert result is not None
    return result
