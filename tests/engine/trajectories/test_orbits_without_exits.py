"""Where exits are not defined at an energy, orbits are followed, and verdicts say that exits are unknown."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import CASES, POTENTIALS, Fate, Orbit, find_lyapunov_orbits, integrate_orbit, judge_orbit, open_result, parse_formula
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits
from engine.trajectories.chaos_indicators import evaluate_indicators
from plots.pictures.orbit_curves import compute_orbit_curves

HILL = POTENTIALS["Hill"]
# A distant retrograde orbit, high above the energy of the necks.
RETROGRADE = (1.2, 0.0, 0.0, -2.7)
RING = parse_formula("½(x² + y²) − ¼(x² + y²)² + 0.01(x⁴ + y⁴ − 6x²y²)")


def equations_of_hill(_t: float, state: np.ndarray) -> list[float]:
    x, y, vx, vy = state
    cube = np.hypot(x, y) ** 3
    return [vx, vy, 2.0 * vy + 3.0 * x - x / cube, -2.0 * vx - y / cube]


@pytest.fixture(scope="module")
def retrograde() -> Orbit:
    return integrate_orbit(HILL, RETROGRADE, 50.0)


def test_an_orbit_is_followed_where_exits_are_not_defined(retrograde: Orbit) -> None:
    with pytest.raises(ValueError, match="choose a lower energy"):
        find_lyapunov_orbits(HILL, retrograde.energy)
    end = solve_ivp(equations_of_hill, (0.0, 50.0), RETROGRADE, "DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    np.testing.assert_allclose([retrograde.x[-1], retrograde.y[-1]], end[:2], atol=1e-7)
    assert retrograde.fate == Fate.BOUNDED
    assert np.hypot(retrograde.x, retrograde.y).max() > np.abs(HILL.saddles).max()


def test_the_verdict_says_that_exits_are_not_known(retrograde: Orbit, tmp_path: Path) -> None:
    verdict = judge_orbit(retrograde)
    assert verdict.outcome == "not known"
    assert verdict.describe().startswith("Followed until t = 50, ")
    assert f"Exits are not known at this energy: {retrograde.exits_unknown}." in verdict.describe()
    assert verdict.summarize().startswith("followed until t = 50")
    retrograde.to_xarray().to_netcdf(tmp_path / "orbit.nc", engine="h5netcdf")
    assert open_result(tmp_path / "orbit.nc").exits_unknown == retrograde.exits_unknown
    known = integrate_orbit(CASES["I"], (0.1, 0.0, 0.0, 0.2), 50.0)
    assert (known.exits_unknown, judge_orbit(known).exits_unknown) == ("", "")
    assert "exits_unknown" not in known.numbers()


def test_collisions_count_without_exits() -> None:
    body = HILL.centres[0]
    orbit = integrate_orbit(HILL, (-0.05, 0.0, np.sqrt(2.0 * (0.3 - float(HILL.value(-0.05, 0.0)))), 0.0), 10.0)
    assert orbit.exits_unknown
    assert orbit.fate == HILL.channels + 1
    assert np.hypot(orbit.x[-1], orbit.y[-1]) == pytest.approx(body.radius, rel=1e-9)
    assert integrate_orbit(HILL, (0.5 * body.radius, 0.0, 0.0, 50.0), 1.0).fate == Fate.OUTSIDE


def test_an_exit_all_around_a_well_is_not_needed() -> None:
    energy = 1.2 * RING.well.channel_mergers[-1].energy
    speed = np.sqrt(2.0 * energy)
    orbit = integrate_orbit(RING, (0.0, 0.0, 0.6 * speed, 0.8 * speed), 100.0)
    assert "it leads all around the well" in orbit.exits_unknown
    assert orbit.fate == Fate.FAILED
    assert compute_birkhoff_digits(RING, (0.0, 0.0, 0.6 * speed, 0.8 * speed), 3000.0).digits.size == 0
    # The orbit has gone far away, so the window shows only its nearby part.
    assert compute_orbit_curves(RING, orbit).window.x_high < 20.0 < np.abs(orbit.x).max()


@pytest.mark.parametrize(
    ("name", "state", "t_max", "reason"),
    [
        ("Hill", (0.1, 0.0, 0.0, 3.0), 3000.0, "the digits of regular and chaotic orbits around a body are not known"),
        ("III", (0.1, 0.0, 0.0, 0.3), 100.0, "t = 100 is too short; the shortest two take t = 2 000"),
        ("III", (0.1, 0.0, 0.3, 0.0), 3000.0, "the orbit runs along an axis"),
    ],
)
def test_the_reason_for_missing_digits_is_true(name: str, state: tuple[float, ...], t_max: float, reason: str) -> None:
    potential = POTENTIALS[name]
    orbit, digits = integrate_orbit(potential, state, t_max), compute_birkhoff_digits(potential, state, t_max)
    assert orbit.fate == Fate.BOUNDED
    assert digits.digits.size == 0
    assert evaluate_indicators(orbit, digits)[-1].sentence == f"No windows to compare: {reason}."
