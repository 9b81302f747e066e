"""Orbits that enter are counted by entrance and exit."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Fate, Potential, classify_orbits, compute_exit_matching, sample_entrances, sample_entrances_by_exit
from engine.measures.basins.starts import Starts, wilson_interval
from engine.results import ExitMatching

UNEQUAL = Potential("unequal", ((2, 0, 0.5), (0, 2, 0.6), (1, 2, -1.0), (3, 0, 0.3)))
ENERGY = 1.2 * UNEQUAL.escape_energy


def match(entrances: list[int], fates: list[int]) -> ExitMatching:
    fate = np.array(fates)
    return compute_exit_matching(entrances, Starts(fate, np.ones(fate.size), np.zeros(fate.size, int)))


def test_pairs_are_counted_and_shares_are_of_an_entrance() -> None:
    matching = match([1, 1, 1, 2, 2, 2, 2], [1, 2, 2, 0, 2, 2, Fate.FAILED])
    assert matching.counts.tolist() == [[0, 1, 2], [1, 0, 2]]
    np.testing.assert_allclose(matching.shares, [[0, 1 / 3, 2 / 3], [1 / 3, 0, 2 / 3]])
    assert matching.returning_share == 0.5
    table = matching.to_pandas().set_index(["entrance", "exit"])
    assert table.loc[(2, 0), "count"] == 1
    assert (table.loc[(1, 2), "share_low"], table.loc[(1, 2), "share_high"]) == wilson_interval(2, 3)
    assert matching.to_xarray().sizes["pair"] == 6


def test_without_orbits_there_are_no_pairs() -> None:
    assert match([], []).describe() == "No orbit enters."


@pytest.mark.parametrize("entrances", [[1], [0, 1], [[1], [2]], [1.5, 2.0]])
def test_each_orbit_has_one_entrance(entrances: list[int]) -> None:
    with pytest.raises(ValueError, match="entrances"):
        match(entrances, [1, 1])


def test_equally_many_orbits_pass_between_two_exits_in_both_directions() -> None:
    """Orbits are drawn according to the flux, and backward in time an orbit leads from its exit to its entrance."""
    entrances, states = sample_entrances_by_exit(UNEQUAL, ENERGY, 4000, rng=5)
    counts = compute_exit_matching(entrances, classify_orbits(UNEQUAL, ENERGY, states, 1e4)).counts[:, 1:]
    assert counts.shape[0] == counts.shape[1] > 1
    assert counts.min() > 10
    # The difference for a pair of exits is normal, and the probability of a false alarm is 4e-8 for each of a few pairs.
    assert np.all(np.abs(counts - counts.T) <= 5.5 * np.sqrt(counts + counts.T))
    # The exits of orbits depend on their entrances.
    assert np.ptp(counts / counts.sum(axis=1, keepdims=True), axis=0).max() > 0.1


def test_states_are_those_of_the_entrances() -> None:
    entrances, states = sample_entrances_by_exit(UNEQUAL, ENERGY, 50, rng=2)
    np.testing.assert_array_equal(states, sample_entrances(UNEQUAL, ENERGY, 50, rng=2))
    # Backward in time orbits leave at once, through the exit by which they enter.
    reversed_states = states * [1.0, 1.0, -1.0, -1.0]
    np.testing.assert_array_equal(classify_orbits(UNEQUAL, ENERGY, reversed_states, 10.0).fate, entrances)
