"""The starts of slices and the default windows of the browser are those of the library."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine import CASES, Potential, parse_formula
from engine.foundations.execution import Execution
from plots.browser.browser_system import make_browser_system
from tests.node import needs_node, run_node
from tests.plots.browser.test_agreement import SLICES

POTENTIALS = {"III": CASES["III"], "a formula with other units": parse_formula("8x² + 4y² − 3x²y")}
LOW, ENERGY, HIGH = 0.1, 0.35, 1.0
# Tolerance for numbers of about 1, because sines and cosines differ in their last bits.
ACCURACY = 1e-14


@needs_node
@pytest.mark.parametrize("name", POTENTIALS)
def test_starts_and_windows_are_those_of_the_library(name: str, tmp_path: Path) -> None:
    potential: Potential = POTENTIALS[name]
    system = make_browser_system(potential, LOW, HIGH, execution=Execution()).to_dict()
    points = np.random.default_rng(1).uniform(-1.0, 1.0, (2, 500))
    points[:, 0] = 0.0
    energies = np.linspace(0.5 * LOW, 1.1 * HIGH, 50)
    data: dict[str, Any] = {"module": system.pop("module"), "system": system}
    data |= {"slices": [plane.to_dict(potential.units) for plane in SLICES], "points": points.tolist()}
    found = run_node("run_starts.js", data | {"energy": ENERGY, "windows": energies.tolist()}, tmp_path)
    for plane, each in zip(SLICES, found["starts"], strict=True):
        states = np.array(each["states"], float).reshape(4, -1).T * potential.units.state
        expected = plane.states(potential, ENERGY, *points)
        forbidden = ~np.isfinite(expected).all(axis=1)
        np.testing.assert_array_equal(np.isnan(states).any(axis=1), forbidden, err_msg=plane.title)
        np.testing.assert_allclose(states[~forbidden], expected[~forbidden], rtol=0.0, atol=ACCURACY, err_msg=plane.title)
    table = system["windows"]["x_px"]
    for energy, window in zip(energies.tolist(), found["windows"], strict=True):
        assert (window is not None) == (table["energies"][0] <= energy <= table["energies"][-1])
        if window is not None:
            edges = [np.interp(energy, table["energies"], column) for column in zip(*table["windows"], strict=True)]
            np.testing.assert_allclose(list(window.values()), edges, rtol=1e-14)
