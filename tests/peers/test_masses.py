"""Orbits of formulas with masses agree with SciPy's DOP853, which integrates H = (px² + py²)/2m + V directly."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import (
    Fate,
    MapSpec,
    ParameterAxis,
    Plane,
    Potential,
    System,
    classify_orbits,
    compute_flux,
    compute_lagrangian_descriptor,
    compute_map,
    find_lyapunov_orbits,
    integrate_orbit,
    open_result,
    parse_formula,
    sample_entrances,
    sample_orbits,
    sample_starts,
    write_formula,
)
from tests.peers.random_systems import random_well

# Seeds of a well at rest and of a well in a rotating frame, and slow seeds, whose kernels take long to compile.
SEEDS = [0, 2, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (3, 4, 5))]


def random_mass(seed: int) -> float:
    return float(10.0 ** np.random.default_rng([71, seed]).uniform(-2.0, 3.0))


def heavy_system(seed: int) -> tuple[Potential, float]:
    """Return a well with a mass, and an energy above the escape energy. Two of three seeds give a rotating frame."""
    mass = random_mass(seed)
    well = parse_formula(f"{write_formula(random_well(seed))}; masses (m, m)", parameters={"m": mass})
    rotating = well.in_rotating_frame((0.0, 0.15, -0.1)[seed % 3] / mass**0.5)
    return rotating, rotating.well.energy_at(1.05 if rotating.channels else 1.0)


def path_of(potential: Potential, state: np.ndarray, times: np.ndarray, mass: float) -> np.ndarray:
    """Return the states at times, from Hamilton's equations with the Coriolis force, of shape (4, n)."""

    def motion(_t: float, state: np.ndarray) -> list[float]:
        x, y, px, py = state
        along_x, along_y = potential.gradient(x, y)
        rate = 2.0 * potential.rotation
        return [px / mass, py / mass, rate * py - along_x, -rate * px - along_y]

    found = solve_ivp(motion, (0.0, times[-1]), state, "DOP853", t_eval=times, rtol=1e-12, atol=1e-13)
    assert found.success
    return np.asarray(found.y)


@pytest.mark.parametrize("seed", SEEDS)
def test_orbits_with_a_mass_obey_their_equations_of_motion(seed: int) -> None:
    (potential, energy), mass = heavy_system(seed), random_mass(seed)
    starts = sample_starts(potential, energy, 5, rng=seed)
    kinetic = (starts[:, 2:] ** 2).sum(axis=1) / (2.0 * mass)
    np.testing.assert_allclose(kinetic + potential.value(*starts[:, :2].T), energy, rtol=1e-12)
    times = np.linspace(0.0, 12.0 * potential.units.time, 60)
    sampled = sample_orbits(potential, starts, times)
    for row, start in enumerate(starts):
        here = np.isfinite(sampled.x[row])
        expected = path_of(potential, start, times[here], mass) if here.sum() > 1 else start[:, None]
        found = np.array([getattr(sampled, name)[row][here] for name in ("x", "y", "px", "py")])
        np.testing.assert_allclose(found / potential.units.state[:, None], expected / potential.units.state[:, None], atol=1e-8)


def test_escape_times_are_those_at_which_the_path_passes_the_exit() -> None:
    potential = parse_formula("½(x² + y²) + x²y − y³/3; masses (8, 8)")
    upper = find_lyapunov_orbits(potential, 0.2)[0]
    starts = sample_starts(potential, 0.2, 40, rng=3)
    outcomes = classify_orbits(potential, 0.2, starts, t_max=300.0)
    left = np.flatnonzero((outcomes.fate == upper.channel) & (outcomes.escape_time > 1.0) & (outcomes.escape_time < 60.0))[:4]
    assert left.size
    places = np.linspace(0, upper.x.size - 1, 20001)
    exit_x, exit_y = (np.interp(places, np.arange(upper.x.size), path) for path in (upper.x, upper.y))
    for row in left:
        *_, end = path_of(potential, starts[row], np.array([0.0, outcomes.escape_time[row]]), 8.0).T
        assert np.hypot(exit_x - end[0], exit_y - end[1]).min() < 1e-3
        orbit = integrate_orbit(potential, starts[row], 300.0)
        assert (orbit.fate, orbit.energy) == (outcomes.fate[row], pytest.approx(0.2, abs=1e-12))


def test_descriptors_are_integrals_of_the_velocity() -> None:
    potential = parse_formula("½(x² + y²) + x²y − y³/3; masses (8, 8)")
    escapes = compute_map(MapSpec(potential, Plane.X_Y, 0.16, (6, 6), t_max=100.0))
    found = compute_lagrangian_descriptor(escapes, duration=20.0, direction="forward")
    row, column = np.argwhere(np.isfinite(found.descriptor) & (escapes.fate != Fate.FORBIDDEN))[0]
    (start,) = escapes.spec.start_states(escapes.x[[column]], escapes.ordinate[[row]])
    times = np.linspace(0.0, 20.0, 20001)
    _, _, px, py = path_of(potential, start, times, 8.0)
    expected = np.trapezoid((np.hypot(px, py) / 8.0) ** 0.5, times)
    assert found.descriptor[row, column] == pytest.approx(expected, rel=1e-5)


def test_entering_orbits_fill_the_volume_inside_at_the_rate_of_the_flux() -> None:
    potential = parse_formula("½(x² + y²) + x²y − y³/3; masses (8, 8)")
    states = sample_entrances(potential, 0.3, 4000, rng=2)
    np.testing.assert_allclose(potential.energy(states), 0.3, atol=1e-12)
    passage = classify_orbits(potential, 0.3, states, t_max=1e4).escape_time
    assert float(passage.mean()) == pytest.approx(compute_flux(potential, 0.3).mean_passage_time, rel=0.06)


def test_a_mass_is_kept_in_formulas_systems_and_files(tmp_path) -> None:
    potential = parse_formula("½(x² + y²) − x²y²; centre (2, 0) 0.1; masses (0.3, 0.3)")
    assert parse_formula(write_formula(potential)) == potential
    path = tmp_path / "map.nc"
    compute_map(MapSpec(potential, Plane.X_PX, 0.2, (4, 4), t_max=10.0)).save(path)
    opened = open_result(path)
    assert opened.spec.potential.mass == 0.3
    assert open_result(path).spec.potential == potential


def test_a_mass_can_be_the_axis_of_a_map() -> None:
    system = System.from_formula("½(x² + y²) + x²y − y³/3; masses (m, m)", m=4.0)
    spec = MapSpec(system.potential, Plane.X_Y, 0.2, (5, 5), t_max=50.0)
    axis = ParameterAxis("m", 1.0, 16.0, system)
    assert [axis.potential(value).mass for value in (1.0, 16.0)] == [1.0, 16.0]
    times = [
        compute_map(MapSpec(axis.potential(mass), Plane.X_Y, 0.2, (5, 5), t_max=50.0 * mass**0.5 / 2)) for mass in (4.0, 16.0)
    ]
    np.testing.assert_array_equal(times[0].fate, compute_map(spec).fate)
    np.testing.assert_array_equal(2.0 * times[0].escape_time, times[1].escape_time)


def test_the_jacobi_constant_of_a_mass_is_that_of_a_unit_mass() -> None:
    at_rest, heavy = (parse_formula(f"−{k}/√(r² + 1){masses}") for k, masses in ((1, ""), (8, "; masses (8, 8)")))
    one, other = at_rest.in_rotating_frame(0.3), heavy.in_rotating_frame(0.3)
    assert other.jacobi_constant(8.0 * -0.5) == pytest.approx(one.jacobi_constant(-0.5))
    assert other.jacobi_energy(1.0) == pytest.approx(8.0 * one.jacobi_energy(1.0))


@pytest.mark.parametrize(
    ("masses", "sentence"),
    [
        ("(8, 2)", "both must be equal; for two masses write V"),
        ("(0, 0)", "must be from 1e-06 to 1e\\+06"),
        ("(x, x)", "a mass must be a number, without x and y"),
        ("8", "is not understood; allowed are .* one masses"),
    ],
)
def test_other_masses_are_refused(masses: str, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        parse_formula(f"½(x² + y²) − x²y; masses {masses}")
