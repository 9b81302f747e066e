"""Lyapunov orbits agree with SciPy and with the limit at the saddle, and have the symmetries and units of the well."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import CASES, Fate, Potential, Stability, classify_orbits, find_lyapunov_orbits, parse_formula
from engine.exits.exit_rows import exit_curves
from engine.integrator.kernels.exit_geometry import REACH, exit_distance
from engine.systems.known_potentials import POTENTIALS
from tests.peers.dop853 import equations

ENERGIES = [
    *(("I", h) for h in (0.1251, 0.5)),
    *(("II", h) for h in (0.1667, 0.5)),
    *(("III", h) for h in (0.2501, 1.0)),
]
ESCAPE_ENERGY = {"I": 1 / 8, "II": 1 / 6, "III": 1 / 4}
# ω_q² is the positive eigenvalue of the saddle's Hessian: the frequency of oscillations across the channel.
OMEGA = {"I": np.sqrt(2), "II": np.sqrt(3), "III": np.sqrt(2)}
SYSTEMS = {**CASES, **POTENTIALS}
each_energy = pytest.mark.parametrize(("name", "energy"), ENERGIES)
each_case = pytest.mark.parametrize("name", CASES)


@each_energy
def test_each_channel_in_order_has_an_orbit_that_agrees_with_scipy(name: str, energy: float) -> None:
    orbits = find_lyapunov_orbits(CASES[name], energy)
    assert [orbit.channel for orbit in orbits] == list(range(1, CASES[name].channels + 1))
    for orbit in orbits:
        np.testing.assert_allclose(CASES[name].value(orbit.x[[0, 100, 200]], orbit.y[[0, 100, 200]]), energy, rtol=0, atol=1e-12)
        # Over one period errors grow by the unstable multiplier, 40 to 90 at these energies: from 1e-13 to 1e-11.
        times, start = np.linspace(0, orbit.period, 201), [orbit.x[0], orbit.y[0], 0.0, 0.0]
        path = solve_ivp(equations(CASES[name]), (0, orbit.period), start, "DOP853", rtol=1e-13, atol=1e-15, t_eval=times).y
        np.testing.assert_allclose(path[:2], [orbit.x, orbit.y], rtol=0, atol=1e-10)


@each_case
def test_period_converges_to_that_of_the_linearized_saddle(name: str) -> None:
    # The difference between the period and 2π/ω_q is proportional to h − escape energy.
    for above, tolerance in ((1e-3, 1e-2), (1e-5, 1e-4), (1e-7, 1e-6)):
        periods = [o.period for o in find_lyapunov_orbits(CASES[name], ESCAPE_ENERGY[name] + above)]
        np.testing.assert_allclose(periods, 2 * np.pi / OMEGA[name], atol=tolerance)


@pytest.mark.parametrize(("name", "energy"), [("I", 0.2), ("II", 0.3), ("III", 0.5), ("Hill", -2.0)])
def test_the_slope_of_the_action_is_the_period(name: str, energy: float) -> None:
    step = 1e-4
    below, orbit, above = (find_lyapunov_orbits(SYSTEMS[name], energy + change)[0] for change in (-step, 0.0, step))
    assert (above.action - below.action) / (2.0 * step) == pytest.approx(orbit.period, rel=1e-6)


@pytest.mark.parametrize(("name", "energy"), [("II", 0.3), ("Hill", -2.0)])
def test_the_path_with_its_momenta_is_a_solution_that_closes(name: str, energy: float) -> None:
    orbit = find_lyapunov_orbits(SYSTEMS[name], energy)[0]
    path = orbit.find_path(4000)
    assert path[0, -1] == pytest.approx(orbit.period)
    np.testing.assert_allclose(path[1:, -1], path[1:, 0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(SYSTEMS[name].energy(path[1:].T), energy, rtol=0, atol=1e-10)
    speeds = (path[1:3, 2:] - path[1:3, :-2]) / (path[0, 2:] - path[0, :-2])
    np.testing.assert_allclose(speeds, path[3:, 1:-1], rtol=0, atol=1e-4)


def test_an_orbit_over_a_saddle_is_unstable() -> None:
    orbit = find_lyapunov_orbits(CASES["I"], 0.19)[0]
    assert orbit.stability is Stability.UNSTABLE
    assert orbit.residue == pytest.approx(0.5 - 0.25 * np.sum(orbit.multipliers).real)
    assert np.isnan(orbit.rotation_number)


@each_case
@pytest.mark.parametrize("below", [0.0, 0.1])
def test_no_orbits_at_or_below_the_escape_energy(name: str, below: float) -> None:
    assert find_lyapunov_orbits(CASES[name], ESCAPE_ENERGY[name] - below) == ()


def test_a_maximum_that_is_not_between_exits_limits_no_energy() -> None:
    quintic = Potential("", ((2, 0, 0.6238), (0, 2, 0.7403), (0, 4, -0.5267), (2, 2, 0.0085), (4, 0, -0.6295), (5, 0, 0.2549)))
    assert min(merger.energy for merger in quintic.well.channel_mergers) > 3.0 * quintic.escape_energy
    assert find_lyapunov_orbits(quintic, 2.0 * quintic.escape_energy)


def test_exits_of_a_separable_well_are_straight() -> None:
    # On x + y = −1, only x − y changes, and oscillates between two turning points.
    orbit = next(o for o in find_lyapunov_orbits(POTENTIALS["Separable"], 0.12) if o.y.mean() < 0)
    np.testing.assert_allclose(orbit.x + orbit.y, -1.0, atol=1e-12)


@pytest.mark.slow
def test_a_strongly_curved_exit_is_found_up_to_twice_the_escape_energy() -> None:
    # Polynomials of degree 16 deviate from this orbit by 2e-10.
    terms = ((2, 0, 1.1195), (0, 2, 0.3893), (1, 5, -0.6884), (2, 1, 0.8214), (4, 0, -0.2547), (3, 0, 0.5214))
    potential = Potential("", terms)
    assert len(find_lyapunov_orbits(potential, 2.0 * potential.escape_energy)) == 2


def test_exit_curves_of_mirror_channels_are_exact_mirror_images_also_beyond_their_ends() -> None:
    # Each exit is asymmetric, so its two ends differ.
    potential = parse_formula("½(x² + y²) − 0.3x²y − x⁴/4")
    assert potential.well.mirror_fates.tolist() == [0, 2, 1]
    one, other = exit_curves(potential, 1.2 * potential.escape_energy)
    for x, y in np.random.default_rng(1).uniform(-2.0, 2.0, (100, 2)):
        assert exit_distance(x, y, one) == exit_distance(-x, y, other)


def test_the_reach_of_an_exit_is_that_of_its_narrower_end() -> None:
    potential = parse_formula("½(x² + y²) − x²y² − x³/4")
    # Channels that are mirror images of each other under y → −y, which exchanges the ends.
    one, other = (orbit.curve[REACH] for orbit in find_lyapunov_orbits(potential, 1.05 * potential.escape_energy))
    assert one == pytest.approx(other)


def test_no_orbit_leaves_a_bent_well_where_it_crosses_the_line_that_continues_an_exit() -> None:
    # The exit is near u = 8/9, with u = x − y²/16. The line x = 1 continues it to the well at y = ±4.
    potential, state = parse_formula("½(x − y²/16)² − ⅜(x − y²/16)³ + y²/128"), np.array([0.0, 0.0, 0.05, 0.513])
    time = 300.0
    x, y = solve_ivp(equations(potential), (0.0, time), state, method="DOP853", rtol=1e-10, atol=1e-12, max_step=0.1).y[:2]
    assert x.max() > 1.1
    assert (x - y**2 / 16).max() < 0.8
    assert classify_orbits(potential, potential.energy(state), state[None], t_max=time).fate.tolist() == [Fate.BOUNDED]
