"""The WebAssembly module: small, and its step is the native one to rounding."""

from __future__ import annotations

import gzip
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine import CASES, Plane, Potential, parse_formula, start_states
from engine.exits.exit_rows import exit_curves, exit_gates
from engine.integrator.jit.webassembly import webassembly_module
from engine.integrator.source.recurrence import LANES, ROWS, TOLERANCE, generate_code
from engine.integrator.source.series import ORDER
from engine.propagation.portable_system import make_portable_system
from engine.systems.compiled import kernels_of
from engine.systems.outcomes import Centre
from tests.node import needs_node, run_node

POTENTIALS = {
    **CASES,
    "typed": parse_formula("½(x² + y²) − x²y² − x³/4"),
    "rotating": parse_formula("½r² − x y²").in_rotating_frame(0.3).with_outcomes([Centre(0.2, 0.1, 0.05)], 0.4),
    "body": parse_formula("½r² − 0.01/√((x − 0.5)² + y²)").with_outcomes([Centre(0.5, 0.0, 0.01)], 0.8),
    "functions": parse_formula("½log(1 + r²) − 0.5x² y exp(−y²) − x³ cos(y)/√(2 + y²)"),
}
ENERGY = 0.29
LARGEST_BYTES = 5120


def test_a_module_has_at_most_5_kb() -> None:
    potential = CASES["III"]
    module = webassembly_module(generate_code(potential.terms, potential.channels))
    assert len(gzip.compress(module)) <= LARGEST_BYTES


def starts(potential: Potential) -> np.ndarray:
    """(n, 5) x, y, px, py, t."""
    chance = np.random.default_rng(1)
    x, px = chance.uniform(-0.3, 0.3, 9), chance.uniform(-0.3, 0.3, 9)
    states = start_states(potential, Plane.X_PX, ENERGY, x, px)
    return np.column_stack([states, np.linspace(0.0, 10.0, 9)])


def native(potential: Potential, states: np.ndarray, gates: np.ndarray, horizon: float) -> tuple[np.ndarray, ...]:
    """The step of the kernels for this machine, its flags with crossings, and the series."""
    kernels = kernels_of(potential)
    now, new = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES))
    flag, crossed = np.zeros(LANES, np.int64), np.zeros(LANES, np.int64)
    now[:5, : len(states)] = states.T
    kernels.step(len(states), TOLERANCE, horizon, gates, now, new, flag, crossed)
    jets = np.zeros((2, ORDER + 1, LANES))
    kernels.jets(len(states), *(row.copy() for row in now[:4]), *jets)
    n = len(states)
    return new[:, :n], np.column_stack([crossed, flag])[:n], jets.reshape(-1, LANES)[:, :n]


@needs_node
@pytest.mark.parametrize("name", ["III", "typed", "rotating", "body", pytest.param("functions", marks=pytest.mark.slow)])
def test_the_step_is_the_native_one_to_rounding(name: str, tmp_path: Path) -> None:
    potential, horizon = POTENTIALS[name].in_well_units, 9.8
    states, gates = starts(potential), exit_gates(exit_curves(potential, ENERGY))
    portable = make_portable_system(potential, ENERGY)
    data: dict[str, Any] = {"system": portable.to_dict(), "module": portable.module, "horizon": horizon}
    found = run_node("run_step.js", {**data, "states": states.tolist(), "gates": gates.tolist()}, tmp_path)
    step, flags, jets = native(potential, states, gates, horizon)
    np.testing.assert_allclose(found["new"], step, rtol=1e-13, atol=1e-15)
    np.testing.assert_array_equal(found["flags"], flags)
    np.testing.assert_allclose(found["jets"], jets, rtol=1e-10, atol=1e-13)
