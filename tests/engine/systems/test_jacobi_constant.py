"""Jacobi constants and names of Lagrange points are those of the literature."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine import (
    POTENTIALS,
    MapSpec,
    Potential,
    classify_orbits,
    compute_map,
    find_lyapunov_orbits,
    open_result,
    parse_formula,
    write_formula,
)

SEEN_FROM_BARYCENTRE = "−(1 − m)/√((x + m)² + y²) − m/√((x + m − 1)² + y²)"
EARTH_MOON = POTENTIALS["Earth-Moon"]


def constant_at(potential: Potential, x: float) -> float:
    """Return C of the critical point that is nearest to (x, 0)."""
    points = potential.critical_points
    nearest = points[np.argmin(np.hypot(points[:, 0] - x, points[:, 1]))]
    return float(potential.jacobi_constant(potential.value(*nearest)))


# Earth and Moon: values of the catalogue of periodic orbits of JPL. Copenhagen: Strömgren's 3.4568 at L2. Hill: 3^(4/3).
@pytest.mark.parametrize(
    ("name", "x", "constant"),
    [
        ("Earth-Moon", -0.15, 3.18834),
        ("Earth-Moon", 0.17, 3.17216),
        ("Earth-Moon", -1.99, 3.01215),
        ("Copenhagen", 0.0, 4.0),
        ("Copenhagen", 1.2, 3.4568),
        ("Hill", -0.69, 3 ** (4 / 3)),
    ],
)
def test_jacobi_constants_agree_with_the_literature(name: str, x: float, constant: float) -> None:
    assert constant_at(POTENTIALS[name], x) == pytest.approx(constant, abs=6e-6 if name != "Copenhagen" else 6e-5)


def test_the_constant_does_not_depend_on_the_body_at_the_origin() -> None:
    letters = {"m": 0.0121505856}
    about_axis = parse_formula(SEEN_FROM_BARYCENTRE, parameters=letters).in_rotating_frame(1.0)
    state = np.array([0.05, 0.02, 0.3, 0.2])
    # The Moon is at x = 1 − m; the velocities in the frame are the same.
    shifted = state + np.array([1.0 - letters["m"], 0.0, 0.0, 0.0])
    constants = [each.jacobi_constant(each.energy(start)) for each, start in ((EARTH_MOON, state), (about_axis, shifted))]
    assert constants[0] == pytest.approx(constants[1], abs=1e-12)


def test_energy_and_constant_are_inverse() -> None:
    energies = np.array([-1.1, -1.05])
    np.testing.assert_allclose(EARTH_MOON.jacobi_energy(EARTH_MOON.jacobi_constant(energies)), energies, rtol=1e-15)


def test_other_quadratic_terms_leave_the_axis_at_the_origin() -> None:
    bowl = parse_formula("x² + y² + x − 1/√(r² + 1)").in_rotating_frame(0.5)
    assert bowl.jacobi_constant(0.25) == -0.5


@pytest.mark.parametrize("name", ["Earth-Moon", "Hill", "Star cluster"])
def test_exits_are_named_after_their_lagrange_points(name: str) -> None:
    potential = POTENTIALS[name]
    labels = [outcome.label for outcome in potential.outcomes]
    # The larger mass is at negative x, and L1 between it and the smaller one.
    assert [labels[k] for k in np.argsort(potential.saddles[:, 0])] == ["L1", "L2"]
    above = potential.escape_energy + 0.01 * abs(potential.escape_energy)
    assert {orbit.name: float(np.sign(orbit.x.mean())) for orbit in find_lyapunov_orbits(potential, above)} == {"L1": -1, "L2": 1}


def test_names_of_exits_are_in_files_and_in_formulas(tmp_path: Path) -> None:
    escapes = compute_map(MapSpec(POTENTIALS["Hill"], "x_y", -2.0, (12, 12), t_max=5.0))
    escapes.save(tmp_path / "hill.nc")
    opened = open_result(tmp_path / "hill.nc")
    assert [outcome.label for outcome in opened.spec.outcomes] == ["L2", "L1", "collision with the planet"]
    assert opened.to_xarray().attrs["jacobi_constant"] == 4.0
    assert parse_formula(write_formula(POTENTIALS["Hill"])).exit_names == ("L2", "L1")


def test_an_exit_of_several_channels_has_their_names() -> None:
    labels = [outcome.label for outcome in EARTH_MOON.outcomes_at((-1.05, -1.0))]
    assert labels[:2] == ["L2, L2+L1 above h = -1.00608", "L1, L1 in L2+L1 above h = -1.00608"]


def test_names_are_not_used_for_another_number_of_exits() -> None:
    potential = parse_formula("½(x² + y²) − x²y²; exits left, right")
    assert potential.outcomes[0].label == "exit 1"


def test_bounded_orbits_of_rotating_systems_are_followed_for_a_short_time_by_default() -> None:
    assert MapSpec(POTENTIALS["Barred galaxy"], "x_px", -3200.0).t_max == pytest.approx(1000.0 / 4.5)
    assert MapSpec(POTENTIALS["Two Yukawa centres"], "x_px", 0.1).t_max == 1000.0
    assert MapSpec(POTENTIALS["I"], "x_px", 0.2).t_max == 1e5
    start = [[0.05, 0.0, 0.0, float(np.sqrt(2 * (-1.09 - EARTH_MOON.value(0.05, 0.0))))]]
    assert classify_orbits(EARTH_MOON, -1.09, start).t_max == 1000.0


def test_a_frame_that_hardly_rotates_turns_about_the_origin() -> None:
    bowl = parse_formula("x − 1/√(r² + 1)").in_rotating_frame(1e-170)
    assert bowl.jacobi_constant(0.25) == -0.5
