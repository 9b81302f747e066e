"""A user's script, which runs with the wheel, and in which `mypy --strict` finds the types of all calls."""

from __future__ import annotations

from typing import assert_type

import numpy as np

import escape_explorer
from escape_explorer import (
    CASES,
    POTENTIALS,
    Coordinate,
    EscapeMap,
    Execution,
    Fate,
    MapSpec,
    Orbit,
    ParameterAxis,
    Plane,
    Potential,
    Slice,
    SweepSpec,
    System,
    Window,
    classify_orbits,
    compute_basin_entropy,
    compute_map,
    compute_regularity,
    compute_statistics,
    compute_wada_test,
    find_lyapunov_orbits,
    find_stable_manifolds,
    fit_decay_laws,
    integrate_orbit,
    judge_orbit,
    parse_formula,
    plan_sweep,
    sample_starts,
)
from escape_explorer.results import BasinEntropy, DecayLaws, Outcomes, RegularityMap, WadaTest

EDGES = (-1.0, 1.0, -1.0, 1.0)


def measure(potential: Potential, energy: float) -> tuple[BasinEntropy, WadaTest]:
    """Return measures of the basins of a small map."""
    spec = MapSpec(potential, Plane.X_PX, energy, resolution=(60, 60), window=EDGES, t_max=1e3)
    assert_type(spec.find_window(), Window)
    escapes = compute_map(spec)
    assert_type(escapes, EscapeMap)
    assert_type(escapes.fractions(), dict[int, float])
    assert_type(compute_regularity(escapes), RegularityMap)
    assert_type(fit_decay_laws(compute_statistics(escapes, EDGES)), DecayLaws)
    return compute_basin_entropy(escapes), compute_wada_test(escapes)


def follow(potential: Potential, energy: float) -> Orbit:
    """Return the orbit of the first of ten random starts."""
    starts = sample_starts(potential, energy, 10, plane=Plane.X_Y, window=EDGES, rng=1)
    assert_type(classify_orbits(potential, energy, starts, t_max=1e3, execution=Execution()), Outcomes)
    orbit = integrate_orbit(potential, starts[0], t_max=1e3)
    print([finding.sentence for finding in judge_orbit(orbit, orbit.compute_birkhoff_digits()).findings])
    assert_type(orbit.fate, int)
    return orbit


entropy, wada = measure(CASES["III"], 0.45)
print(entropy.describe(), wada.describe())
print(follow(parse_formula("½(x² + y²) − x²y"), 0.2).fate >= Fate.BOUNDED)
print(plan_sweep(SweepSpec(POTENTIALS["HH"], "x_px", [0.2, 0.3], window=EDGES, t_max=100.0)).describe())
print(SweepSpec(POTENTIALS["HH"], Plane.X_PX, np.linspace(0.2, 0.3, 2), window=EDGES).count)
print([orbit.period for orbit in find_lyapunov_orbits(CASES["I"], 0.19)])
print(len(find_stable_manifolds(CASES["I"], 0.19, images=1, window=EDGES).arcs))
assert_type(MapSpec(CASES["I"], "x_px", 0.19, window=EDGES).trace_zero_velocity_curve(), list[np.ndarray])
print(Slice(Coordinate.X, Coordinate.PX, fixed=[(Coordinate.Y, 0.1)]) == Slice("x", "px", fixed={"y": 0.1}))
print(Slice("x", "theta", fixed={Coordinate.Y: 0.1}).title, MapSpec(CASES["I"], "x,py", 0.19, window=EDGES).plane.title)
system = System.from_formula("½(x² + y²) − b x²y", b=0.5)
print(MapSpec(system.potential, Slice(Coordinate.X, ParameterAxis("b", 0.5, 2.0, system.potential)), 0.3).outcomes)
assert_type(escape_explorer.__version__, str)
