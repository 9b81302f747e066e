"""The WebAssembly modules are small, and their steps equal native steps to rounding."""

from __future__ import annotations

import gzip
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine import CASES, Plane, Potential, parse_formula, start_states
from engine.exits.exit_rows import exit_curves
from engine.exits.exit_shapes import exit_gates
from engine.integrator.jit.webassembly import webassembly_module
from engine.integrator.kernels.lanes import VECTOR
from engine.integrator.kernels.propagate import Exits
from engine.integrator.portable_kernels import kernel_module
from engine.integrator.source.recurrence import TOLERANCE, outline_code
from engine.integrator.source.series import ORDER
from engine.propagation.batch import OrbitBatch
from engine.slices.portable_system import make_portable_system
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
STEPS, HORIZON = 6, 1.8
LARGEST_BYTES, LARGEST_KERNELS = 5120, 16384


def test_a_module_has_at_most_5_kb() -> None:
    potential = CASES["III"]
    module = webassembly_module(outline_code(potential.well.structure))
    assert len(gzip.compress(module)) <= LARGEST_BYTES


def test_the_kernels_have_at_most_16_kb() -> None:
    assert len(gzip.compress(kernel_module())) <= LARGEST_KERNELS


def starts(potential: Potential) -> np.ndarray:
    """Return random starts x, y, px, py, of shape (n, 4)."""
    chance = np.random.default_rng(1)
    x, px = chance.uniform(-0.3, 0.3, 9), chance.uniform(-0.3, 0.3, 9)
    return start_states(potential, Plane.X_PX, ENERGY, x, px)


def native(potential: Potential, state: np.ndarray, curves: np.ndarray) -> dict[str, np.ndarray]:
    """Return the first steps of an orbit by the kernels for this machine, its crossings, and the series of the first step."""
    kernels, steps = potential.well.kernels, np.zeros((STEPS, 5))
    batch = OrbitBatch.from_starts(state[None], np.zeros(1, np.int64))
    exits = Exits(exit_gates(curves), curves[None], batch.curve_row)
    orbits = batch.for_kernels(np.ones(1, np.uint8))
    taken = kernels.propagate(np.zeros(1, np.int64), HORIZON, True, TOLERANCE, VECTOR * STEPS, 0, exits, orbits, steps)
    series = np.zeros((2, ORDER + 1, 1))
    kernels.jets(1, *state[:, None], *series)
    return {"steps": steps.ravel(), "taken": taken, "crossings": batch.crossings[0], "series": series.ravel()}


@needs_node
@pytest.mark.parametrize(
    "name", ["III", "typed", *(pytest.param(name, marks=pytest.mark.slow) for name in ("rotating", "body", "functions"))]
)
def test_the_first_steps_equal_native_steps_to_rounding(name: str, tmp_path: Path) -> None:
    potential = POTENTIALS[name].in_well_units
    states, curves = starts(potential), exit_curves(potential, ENERGY)
    portable = make_portable_system(potential, 2.0 * ENERGY)
    data: dict[str, Any] = {"system": portable.to_dict(), "module": portable.module, "horizon": HORIZON, "energy": ENERGY}
    found = run_node("run_step.js", {**data, "states": states.tolist(), "count": STEPS}, tmp_path)
    for state, orbit in zip(states, found, strict=True):
        expected = native(potential, state, curves)
        np.testing.assert_allclose(orbit["steps"], expected["steps"], rtol=1e-11, atol=1e-12)
        np.testing.assert_allclose(orbit["series"], expected["series"], rtol=1e-10, atol=1e-13)
        assert (orbit["taken"], orbit["crossings"]) == (expected["taken"], expected["crossings"])
