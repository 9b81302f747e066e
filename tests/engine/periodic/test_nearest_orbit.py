"""Periodic orbits have the periods and stability of closed forms, of publications and of another integrator."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import (
    CASES,
    POTENTIALS,
    NoPeriodicOrbitError,
    PeriodicOrbit,
    Potential,
    Stability,
    find_lyapunov_orbits,
    find_periodic_orbit,
    parse_formula,
)

III, HH, HILL = CASES["III"], POTENTIALS["HH"], POTENTIALS["Hill"]
# Periods and stability indices of case III at h = 0.3, each with a place (x, px) near a return, and the number of returns.
IN_CASE_III = [
    ((0.0, 0.0), 1, 2.0 * np.pi, -0.340506),
    ((0.6, 0.0), 1, 6.8438337339, 3.159324),
    ((0.0, 0.31), 1, 10.3753286223, -0.252737),
    ((0.47, 0.31), 2, 16.9148965675, -0.841334),
    ((0.515, 0.425), 2, 17.0448410670, 5.329565),
]


def state_on(potential: Potential, energy: float, x: float, px: float) -> np.ndarray:
    """The state with y = 0 and py > 0."""
    return np.array([x, 0.0, px, np.sqrt(2.0 * (energy - potential.value(x, 0.0)) - px * px)])


@pytest.mark.parametrize(("place", "returns", "period", "index"), IN_CASE_III)
def test_orbits_of_case_iii_are_found_from_a_place_nearby(
    place: tuple[float, float], returns: int, period: float, index: float
) -> None:
    orbit = find_periodic_orbit(III, state_on(III, 0.3, *place), returns)
    assert orbit.returns == returns
    assert orbit.period == pytest.approx(period, abs=1e-9)
    assert orbit.stability_index == pytest.approx(index, abs=1e-6)
    assert orbit.energy == pytest.approx(0.3, abs=1e-13)


def test_orbits_of_henon_and_heiles_have_known_starts_and_traces() -> None:
    # At E = 0.1: the orbits C and B on the section x = 0, px > 0.
    for y, y0, period, trace in [
        (0.27, 0.27550602600, 6.11049967861, 0.08842485),
        (-0.15, -0.14619013945, 6.79438482685, 2.95480549),
    ]:
        start = [0.0, y, np.sqrt(0.2 - 2.0 * HH.value(0.0, y)), 0.0]
        orbit = find_periodic_orbit(HH, start, 1, section="x = 0, px > 0")
        assert orbit.y[0] == pytest.approx(y0, abs=1e-10)
        assert orbit.period == pytest.approx(period, abs=1e-10)
        assert 2.0 * orbit.stability_index == pytest.approx(trace, abs=1e-7)


# Largest multiplier of the orbit y = 0 of case I, by Mathieu's equation with a = 4, q = 4 √(2h).
MATHIEU = {0.13: 1.8110179097, 0.15: 1.9759288610, 0.20: 2.4404084116, 0.30: 3.6053023236}


@pytest.mark.parametrize("energy", MATHIEU)
def test_the_orbit_along_the_axis_of_case_i_has_the_multiplier_of_mathieus_equation(energy: float) -> None:
    orbit = find_periodic_orbit(CASES["I"], [0.0, 0.0, np.sqrt(2.0 * energy), 0.0], 1, section="x = 0 up")
    assert orbit.period == pytest.approx(2.0 * np.pi, abs=1e-11)
    assert orbit.multipliers[0].real == pytest.approx(MATHIEU[energy], abs=1e-9)
    assert np.prod(orbit.multipliers) == pytest.approx(1.0, abs=1e-9)


def test_a_lyapunov_orbit_is_found_as_a_periodic_orbit() -> None:
    lyapunov = find_lyapunov_orbits(CASES["II"], 0.25)[0]
    path = np.column_stack([lyapunov.x, lyapunov.y])
    # Half a quarter of the period later, at which the section is crossed.
    orbit = find_periodic_orbit(CASES["II"], [*path[0], 0.0, 0.0], 1, section=section_through_middle(lyapunov))
    assert orbit.period == pytest.approx(lyapunov.period, abs=1e-10)
    multiplier = abs(lyapunov.multipliers[0])
    assert abs(orbit.multipliers[0]) == pytest.approx(multiplier, rel=1e-7)


def section_through_middle(lyapunov: object) -> str:
    return "x = 0 up" if np.ptp(getattr(lyapunov, "x")) > np.ptp(getattr(lyapunov, "y")) else "y = 0 up"  # noqa: B009


def derivatives(potential: Potential, t: float, values: np.ndarray) -> np.ndarray:
    """The equations of motion with their variational equations, for a state and a matrix (4, 4) in a row."""
    x, y, px, py = values[:4]
    slope_x, slope_y = potential.gradient(x, y)
    spin = 2.0 * potential.rotation
    flow = np.zeros((4, 4))
    flow[:2, 2:] = np.eye(2)
    flow[2:, :2] = -potential.hessian_matrix(x, y)
    flow[2:, 2:] = [[0.0, spin], [-spin, 0.0]]
    change = [px, py, spin * py - slope_x, -spin * px - slope_y]
    return np.concatenate([change, (flow @ values[4:].reshape(4, 4)).ravel()])


SYSTEMS = {
    "III": (III, [0.1, 0.0, 0.05, 0.6]),
    "HH": (HH, [0.05, 0.0, 0.1, 0.4]),
    "typed": (parse_formula("½(x² + 1.3y²) + x²y − 0.3y³ + 0.2x³"), [0.1, 0.0, 0.05, 0.25]),
    "in other units": (parse_formula("40(x² + 2y²) + 0.001x³y"), [1.0, 0.0, 0.0, 4.0]),
    "Hill": (HILL, [0.28, 0.0, 0.0, 1.5]),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_another_integrator_finds_the_orbit_closed_and_the_same_stability(name: str) -> None:
    potential, start = SYSTEMS[name]
    orbit = find_periodic_orbit(potential, start)
    begin = np.concatenate([orbit.start, np.eye(4).ravel()])
    end = solve_ivp(
        lambda t, values: derivatives(potential, t, values), (0.0, orbit.period), begin, "DOP853", rtol=1e-13, atol=1e-13
    ).y[:, -1]
    np.testing.assert_allclose(end[:4], orbit.start, atol=1e-9)
    index = 0.5 * (np.trace(end[4:].reshape(4, 4)) - 2.0)
    assert orbit.stability_index == pytest.approx(index, rel=1e-8, abs=1e-8)


def test_the_orbit_need_not_start_on_the_section() -> None:
    on_section = find_periodic_orbit(III, state_on(III, 0.3, 0.6, 0.0), 1)
    path = on_section.find_path(40)
    elsewhere = find_periodic_orbit(III, path[1:, 17], 1)
    assert elsewhere.period == pytest.approx(on_section.period, abs=1e-10)
    np.testing.assert_allclose(elsewhere.points, on_section.points, atol=1e-9)


def test_a_multiple_of_the_number_of_returns_finds_the_orbit_itself() -> None:
    assert find_periodic_orbit(III, state_on(III, 0.3, 0.595, 0.0), 3).returns == 1


def test_without_a_number_of_returns_the_nearest_orbit_is_found() -> None:
    orbit = find_periodic_orbit(III, state_on(III, 0.3, 0.467, 0.306))
    assert orbit.returns == 2
    assert orbit.period == pytest.approx(16.9148965675, abs=1e-9)


def test_all_returns_of_the_orbit_are_listed_wherever_newtons_method_leads() -> None:
    # From this start, Newton's method for two returns leads to an orbit with six apsides.
    start = [0.0, -0.275527238991697, 0.13830522512861262, 0.45936034227790645]
    orbit = find_periodic_orbit(HH, start, 2, section="apsis")
    x, y, px, py = orbit.find_path(4000)[1:]
    radial = x * px + y * py
    # The first return, at which the path begins and ends, is no change of sign within it.
    assert orbit.returns == 1 + np.count_nonzero(np.diff(np.sign(radial[np.abs(radial) > 1e-9])))


def test_a_state_that_returns_after_no_time_is_no_orbit() -> None:
    separable = parse_formula("½(x² + y²) + 0.1x³ + 0.2y³")
    start = [0.0, 0.5708715834425757, 0.6885532914871342, 0.0]
    orbit = find_periodic_orbit(separable, start, section="pericentre")
    assert orbit.period > 1.0


def test_the_path_closes_and_contains_the_returns() -> None:
    orbit = find_periodic_orbit(III, state_on(III, 0.3, 0.515, 0.425), 2)
    path = orbit.find_path(300)
    np.testing.assert_allclose(path[1:, -1], path[1:, 0], atol=1e-9)
    assert path[0, -1] == pytest.approx(orbit.period)
    np.testing.assert_allclose(potential_energies(orbit, path), 0.3, atol=1e-11)


def potential_energies(orbit: PeriodicOrbit, path: np.ndarray) -> np.ndarray:
    return np.array([orbit.potential.energy(state) for state in path[1:].T])


@pytest.mark.parametrize(("index", "stability"), [(0.3, "stable"), (1.5, "unstable"), (-1.5, "unstable with reflection")])
def test_the_stability_follows_from_the_index(index: float, stability: str) -> None:
    assert Stability.of(index).value == stability


def test_a_message_says_why_no_orbit_is_found() -> None:
    with pytest.raises(NoPeriodicOrbitError, match="does not return 1 time to y = 0 before it ends or t_max=50"):
        find_periodic_orbit(III, [0.0, 0.0, 0.9, 0.9], 1, t_max=50.0)


def test_an_orbit_may_start_so_near_to_a_body_that_a_step_takes_less_than_a_thousandth() -> None:
    start = (0.5022683168764797, 0.0, 0.0, 20.975474325478434)
    orbit = find_periodic_orbit(POTENTIALS["Copenhagen"], start, 1, t_max=20.0)
    np.testing.assert_allclose(orbit.start, start, rtol=1e-8, atol=1e-12)
    assert orbit.period == pytest.approx(7.640735009, abs=1e-8)


def test_an_orbit_that_collides_has_no_further_returns() -> None:
    # Within a body the steps would shrink for ever.
    start = [-0.4924421090451381, 0.0, -10.519685765771072, -4.347225551183829]
    with pytest.raises(NoPeriodicOrbitError, match="does not return 4 times to y = 0"):
        find_periodic_orbit(POTENTIALS["Copenhagen"], start, 4)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"returns": 0}, "returns=0: must be"),
        ({"state": [0.0, np.nan, 0.0, 0.1]}, "state"),
        ({"section": "nonsense"}, "section"),
        ({"t_max": -1.0}, "t_max"),
    ],
)
def test_what_is_not_legal_is_refused(arguments: dict[str, object], message: str) -> None:
    legal: dict[str, object] = {"state": [0.0, 0.0, 0.1, 0.4], "returns": 1}
    with pytest.raises(ValueError, match=message):
        find_periodic_orbit(III, **{**legal, **arguments})  # type: ignore[arg-type]
