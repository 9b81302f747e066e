"""The origin of an orbit is the fate of the reversed orbit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, classify_orbits, compute_map, compute_origin_fates, start_states
from engine.maps.origin_fates import join_origin_fates
from engine.results import OriginFateMap

# Channel numbers under y → −y; 0 is bounded.
MIRRORED_IN_Y = {"I": [0, 2, 1], "II": [0, 1, 3, 2], "III": [0, 4, 3, 2, 1]}
SIDE = 60


def origin_fates(name: str, plane: Plane, energy: float | tuple[float, float]) -> OriginFateMap:
    return compute_origin_fates(MapSpec(CASES[name], plane, energy, (SIDE, SIDE), t_max=1e3))


def mirrored_in_y(name: str, fate: np.ndarray) -> np.ndarray:
    channels = np.array(MIRRORED_IN_Y[name])
    return np.where(fate > 0, channels[np.maximum(fate, 0)], fate)


def test_origin_is_the_fate_of_the_reversed_start() -> None:
    name, energy = "III", 0.35
    whole = origin_fates(name, Plane.X_PX, energy)
    rows, columns = np.nonzero(whole.origin >= 0)
    rows, columns = rows[::11], columns[::11]
    states = start_states(CASES[name], Plane.X_PX, energy, whole.x[columns], whole.ordinate[rows])
    reversed_fates = classify_orbits(CASES[name], energy, states * [1.0, 1.0, -1.0, -1.0], 1e3).fate
    np.testing.assert_array_equal(whole.origin[rows, columns], reversed_fates)


@pytest.mark.parametrize(
    ("name", "plane", "energy"), [("I", Plane.X_PX, 0.17), ("II", Plane.X_Y, 0.2), ("III", Plane.X_PX, 0.35)]
)
def test_origins_are_mirrored_fates_for_potentials_even_in_y(name: str, plane: Plane, energy: float) -> None:
    # Reversal and y → −y together map (x, px) to (x, −px), and (x, y) to (x, −y): rows are reversed.
    whole = origin_fates(name, plane, energy)
    expected = mirrored_in_y(name, whole.fate[::-1])
    differing = whole.origin != expected
    # Chaos amplifies the rounding errors of mirrored orbits that escape late.
    assert np.mean(differing[whole.fate >= 0]) < 0.02


def test_share_of_captured_orbits_decreases_with_t_max() -> None:
    # By Liouville's theorem, orbits that enter and never leave have measure zero.
    shares = []
    for t_max in (100.0, 10_000.0):
        spec = MapSpec(CASES["III"], Plane.X_PX, 0.35, (SIDE, SIDE), t_max=t_max)
        counts = compute_origin_fates(spec).count_passages()
        shares.append(counts[1:, 0].sum() / counts.sum())
    assert shares[1] < 0.2 * shares[0]


def test_passages_count_each_interior_start_once() -> None:
    whole = origin_fates("II", Plane.X_PX, 0.2)
    counts = whole.count_passages()
    assert counts.shape == (4, 4)
    assert counts.sum() == np.sum(whole.fate >= 0)
    assert counts[1, 2] == np.sum((whole.origin == 1) & (whole.fate == 2))


def test_joining_maps_of_different_requests_raises() -> None:
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.3, (8, 8), t_max=50.0)
    forward, other = compute_map(spec), compute_map(replace(spec, energy=0.31, backward=True))
    with pytest.raises(ValueError, match="backward: is a map of"):
        join_origin_fates(forward, other)
