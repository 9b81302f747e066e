"""Maps, statistics and curves of a system with two exits and a collision count and name all three."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import (
    POTENTIALS,
    Coordinate,
    EscapeMap,
    Fate,
    MapSpec,
    Plane,
    Slice,
    compute_map,
    compute_origin_fates,
    compute_statistics,
)
from tests.disc import LABELS, disc_map


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return disc_map()


def test_each_outcome_has_its_share(escape_map: EscapeMap) -> None:
    interior, shares = escape_map.fate[escape_map.interior], escape_map.fractions()
    assert [shares[k] for k in (1, 2, 3)] == [float(np.mean(interior == k)) for k in (1, 2, 3)]
    assert min(shares[k] for k in (1, 2, 3)) > 0.1
    assert set(LABELS) <= set(escape_map.numbers())


def test_orbits_that_end_at_a_singularity_are_counted_and_not_called_bounded(escape_map: EscapeMap) -> None:
    fate = np.where(escape_map.fate == 3, Fate.FAILED, escape_map.fate)
    unresolved = replace(escape_map, fate=fate)
    assert unresolved.fractions()[Fate.FAILED] == escape_map.fractions()[3]
    assert unresolved.fractions()[Fate.BOUNDED] == escape_map.fractions()[Fate.BOUNDED]
    assert unresolved.numbers()["unresolved"] == escape_map.fractions()[3]


def test_statistics_have_a_count_for_each_outcome(escape_map: EscapeMap) -> None:
    statistics = compute_statistics(escape_map)
    assert statistics.channel_counts == tuple(int(np.sum(escape_map.fate == k)) for k in (1, 2, 3))
    assert [outcome.label for outcome in statistics.outcomes] == LABELS
    assert statistics.escaped == int(np.sum(escape_map.fate >= 1))


def test_passages_are_counted_between_all_outcomes(escape_map: EscapeMap) -> None:
    origins = compute_origin_fates(escape_map.spec)
    counts = origins.count_passages()
    assert counts.shape == (4, 4)
    assert counts[3, 1] == np.sum((origins.origin == 3) & (origins.fate == 1)) > 0
    assert "channel" not in origins.describe()


@pytest.mark.parametrize(("name", "x", "energy"), [("Hill", 0.0, -1.9), ("Copenhagen", 0.5, -1.9)])
@pytest.mark.parametrize(
    "plane", [Plane.X_Y, Slice(Coordinate.X, Coordinate.Y, fixed=((Coordinate.THETA, 0.0),)), Plane.TANGENTIAL]
)
def test_a_start_at_the_centre_of_a_body_is_outside(name: str, x: float, energy: float, plane: Slice) -> None:
    window = (x - 9e-4, x + 9e-4, -9e-4, 9e-4)
    found = compute_map(MapSpec(POTENTIALS[name], plane, energy, (3, 3), window, t_max=20.0))
    assert POTENTIALS[name].value(found.x[1], found.ordinate[1]) == -np.inf
    assert (found.fate == Fate.OUTSIDE).all()
