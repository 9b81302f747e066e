"""An orbit at rest at both ends belongs to the channel that it separates from the well."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, find_lyapunov_orbits, parse_formula
from engine.exits.path_crossings import closes_channel
from engine.exits.saddle_orbits.brake_orbits import find_directly
from engine.systems.known_potentials import POTENTIALS
from tests.peers.symmetric_wells import VALLEYS

AT_REST = [name for name, potential in POTENTIALS.items() if potential.channels and not potential.rotation]
# Wells at x = 0, ±7.77, … with saddles at x = ±3.88, ±11.65, … between them. A search from the saddle at 3.88 finds an orbit
# across the neck at 11.65.
ROW = parse_formula("−cos(0.8090x) − 0.9825cos(y) + 0.19826xy² + 0.26226x²y²")


def arc(radius: float, first: float, last: float) -> np.ndarray:
    """Return a path (2, 101) along a circle about the origin, between angles in degrees."""
    angle = np.radians(np.linspace(first, last, 101))
    return radius * np.array([np.cos(angle), np.sin(angle)])


@pytest.mark.parametrize(
    ("path", "closed"),
    [
        (arc(1.2, -20.0, 20.0), [1]),
        (arc(1.2, 100.0, 140.0), [2]),
        (arc(1.2, 20.0, 60.0), []),
        (arc(1.2, -20.0, 140.0), []),
        (arc(0.1, 0.0, 359.0) + np.array([[1.2], [0.0]]), []),
        (np.array([np.zeros(101), np.linspace(-1.0, 1.0, 101)]), []),
    ],
    ids=["across a channel", "across another", "between two", "across two", "out and back", "through the origin"],
)
def test_a_path_closes_the_channel_whose_line_it_crosses_alone(path: np.ndarray, closed: list[int]) -> None:
    potential = CASES["II"].in_well_units
    assert [channel for channel in (1, 2, 3) if closes_channel(potential, 0.5, channel, path)] == closed


def test_an_orbit_that_has_moved_from_its_saddle_into_the_well_is_taken_until_it_reaches_the_origin() -> None:
    potential = parse_formula("½(0.5507x² + 0.7440y²) − 0.4614x²y² + 0.21704x³")
    (orbit,) = find_lyapunov_orbits(potential, potential.well.energy_at(4.9))
    saddle = potential.saddles[orbit.channel - 1]
    assert 0.4 * saddle[0] < orbit.x.min() < orbit.x.max() < 0.25 * saddle[0] < 0.0
    # At this energy, the orbit along the y axis has passed the origin.
    with pytest.raises(ValueError, match=f"no Lyapunov orbit was found across channel {orbit.channel}"):
        find_lyapunov_orbits(potential, potential.well.energy_at(10.0))


def test_an_orbit_beyond_a_neighbouring_well_is_not_taken() -> None:
    with pytest.raises(ValueError, match="no Lyapunov orbit was found across channel 1"):
        find_lyapunov_orbits(ROW, ROW.well.energy_at(4.585))


@pytest.mark.parametrize("name", AT_REST)
@pytest.mark.parametrize("factor", [1.0001, 1.3, 2.0])
def test_lyapunov_orbits_of_the_catalogue_close_their_channels(name: str, factor: float) -> None:
    potential = POTENTIALS[name].in_well_units
    energy = potential.well.energy_at(factor)
    for channel in potential.well.open_channels(energy):
        orbit = find_directly(potential, energy, channel)
        # Twice the escape energy is too high for a search in the separable well.
        assert orbit is None or closes_channel(potential, energy, channel, orbit.path)


def test_an_orbit_across_another_neck_is_not_taken() -> None:
    # A search from the saddle at (−0.44, 1.60) finds an orbit along the x axis, with the ends (4.13, 0.00) and (−4.13, −0.13).
    potential = parse_formula(VALLEYS)
    orbits = find_lyapunov_orbits(potential, 6.0)
    across = next(orbit for orbit in orbits if potential.saddles[orbit.channel - 1] == pytest.approx([-0.4428538, 1.6046674]))
    assert across.period == pytest.approx(0.828307, abs=1e-6)
    assert across.y.min() > 5.8
