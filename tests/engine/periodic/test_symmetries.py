"""Symmetries map orbits onto orbits, in frames at rest and in rotating frames."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, POTENTIALS, Potential, integrate_orbit, parse_formula
from engine.periodic.symmetries import Symmetry, symmetries_of


def names(potential: Potential) -> set[str]:
    return {symmetry.name for symmetry in symmetries_of(potential)}


def test_a_system_at_rest_has_each_reflection_with_and_without_reversed_time() -> None:
    assert names(POTENTIALS["HH"]) == {"reversed time", "x → −x", "x → −x with reversed time"}
    assert len(symmetries_of(CASES["III"])) == 7
    assert names(parse_formula("½(x² + y²) + x²y + 0.3 x³")) == {"reversed time"}


def test_a_rotating_system_reverses_time_with_each_reflection() -> None:
    assert names(POTENTIALS["Hill"]) == {"x → −x with reversed time", "y → −y with reversed time", "rotation by 180°"}


@pytest.mark.parametrize("name", ["III", "HH", "Hill", "Copenhagen"])
def test_the_image_of_an_orbit_is_an_orbit(name: str) -> None:
    potential = POTENTIALS[name]
    start = np.array([0.21, 0.13, 0.3, -0.2])
    for symmetry in symmetries_of(potential):
        image = end_of(potential, start * symmetry.factors, reversed_time=symmetry.reverses_time)
        np.testing.assert_allclose(image, end_of(potential, start, reversed_time=False) * symmetry.factors, atol=1e-11)


def end_of(potential: Potential, start: np.ndarray, *, reversed_time: bool) -> np.ndarray:
    """The state a little later or, with reversed time, earlier: the orbit of the reversed frame with reversed momenta."""
    if reversed_time:
        reversed_potential = potential.reversed_in_time
        orbit = integrate_orbit(reversed_potential, start * [1, 1, -1, -1], t_max=0.5)
        return np.array([orbit.x[-1], orbit.y[-1], -orbit.px[-1], -orbit.py[-1]])
    orbit = integrate_orbit(potential, start, t_max=0.5)
    return np.array([orbit.x[-1], orbit.y[-1], orbit.px[-1], orbit.py[-1]])


def test_the_name_says_both_parts() -> None:
    assert Symmetry((1.0, -1.0), reverses_time=True).name == "y → −y with reversed time"
