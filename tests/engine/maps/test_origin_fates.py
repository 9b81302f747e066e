"""Origin and fate: the past of an orbit is the future of the reversed one."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from dataclasses import replace

import numpy as np
import pytest

from engine import (
    CASES,
    Fate,
    MapSpec,
    OriginFateMap,
    Plane,
    classify_orbits,
    compute_map,
    compute_origin_fates,
    join_origin_fates,
    start_states,
)

# Channel numbers under y → −y; 0 is bounded.
MIRRORED_IN_Y = {"I": [0, 2, 1], "II": [0, 1, 3, 2], "III": [0, 4, 3, 2, 1]}
SIDE = 60


def origin_fates(name: str, plane: Plane, energy: float | tuple[float, float]) -> OriginFateMap:
    return compute_origin_fates(MapSpec(CASES[name], plane, energy, (SIDE, SIDE), t_max=1e3))


def mirrored_in_y(name: str, fate: np.ndarray) -> np.ndarray:
    channels = np.array(MIRRORED_IN_Y[name])
    return np.where(fate > 0, channels[np.maximum(fate, 0)], fate)


@pytest.mark.parametrize(("name", "energy"), [("I", 0.17), ("II", 0.2), ("III", 0.35)])
def test_the_origin_is_the_fate_of_the_reversed_start(name: str, energy: float) -> None:
    whole = origin_fates(name, Plane.X_PX, energy)
    rows, columns = np.nonzero(whole.origin >= 0)
    rows, columns = rows[::11], columns[::11]
    states = start_states(CASES[name], Plane.X_PX, energy, whole.x[columns], whole.ordinate[rows])
    reversed_fates = classify_orbits(CASES[name], energy, states * [1.0, 1.0, -1.0, -1.0], 1e3).fate
    np.testing.assert_array_equal(whole.origin[rows, columns], reversed_fates)


@pytest.mark.parametrize(("name", "plane", "energy"), [
    ("I", Plane.X_PX, 0.17), ("II", Plane.X_PX, 0.2), ("III", Plane.X_PX, 0.35),
    ("I", Plane.X_Y, 0.17), ("II", Plane.X_Y, 0.2), ("III", Plane.X_Y, 0.35),
])  # fmt: skip
def test_in_a_potential_even_in_y_origins_are_the_mirrored_fates(name: str, plane: Plane, energy: float) -> None:
    # Reversal and y → −y together carry (x, px) into (x, −px), and (x, y) into (x, −y): the picture upside down.
    whole = origin_fates(name, plane, energy)
    expected = mirrored_in_y(name, whole.fate[::-1])
    differing = whole.origin != expected
    # Chaos amplifies the rounding of a mirrored orbit that stays long.
    assert np.mean(differing[whole.fate >= 0]) < 0.02


def test_an_orbit_captured_for_ever_is_a_rarity() -> None:
    # Liouville's theorem: what comes in and never leaves has measure zero, so its share falls as t_max grows.
    shares = []
    for t_max in (100.0, 10_000.0):
        spec = MapSpec(CASES["III"], Plane.X_PX, 0.35, (SIDE, SIDE), t_max=t_max)
        counts = compute_origin_fates(spec).count_passages()
        shares.append(counts[1:, 0].sum() / counts.sum())
    assert shares[1] < 0.2 * shares[0]


def test_passages_count_every_start_once() -> None:
    whole = origin_fates("II", Plane.X_PX, 0.2)
    counts = whole.count_passages()
    assert counts.shape == (4, 4)
    assert counts.sum() == np.sum(whole.fate >= 0)
    assert counts[1, 2] == np.sum((whole.origin == 1) & (whole.fate == 2))


def test_passages_are_as_frequent_as_their_reversals() -> None:
    # The section is carried onto itself by reversal and mirror: through 1 from 2 as often as through 2' from 1'.
    channels = MIRRORED_IN_Y["III"]
    counts = origin_fates("III", Plane.X_PX, 0.45).count_passages()
    reversed_counts = counts.T[np.ix_(channels, channels)]
    np.testing.assert_allclose(counts, reversed_counts, atol=0.01 * counts.sum())


def test_on_x_h_every_energy_has_its_origins() -> None:
    whole = origin_fates("I", Plane.X_H, (0.13, 0.4))
    np.testing.assert_array_equal(whole.origin[-1] > 0, whole.fate[-1] > 0)
    assert np.any(whole.origin[-1] > 0)


def test_starts_that_do_not_exist_have_no_origin() -> None:
    whole = origin_fates("I", Plane.X_PX, 0.17)
    np.testing.assert_array_equal(whole.origin == Fate.FORBIDDEN, whole.fate == Fate.FORBIDDEN)
    np.testing.assert_array_equal(whole.origin == Fate.OUTSIDE, whole.fate == Fate.OUTSIDE)


def test_a_dataset_tells_both() -> None:
    dataset = origin_fates("I", Plane.X_PX, 0.17).to_xarray()
    assert dataset["origin"].dims == ("px", "x")
    assert "forbidden" in dataset["origin"].attrs["codes"]
    assert dataset.attrs["energy"] == 0.17


def test_maps_that_do_not_belong_together_are_refused() -> None:
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.3, (8, 8), t_max=50.0)
    forward, other = compute_map(spec), compute_map(replace(spec, energy=0.31, backward=True))
    with pytest.raises(ValueError, match="backward"):
        join_origin_fates(forward, other)


def test_a_map_that_is_not_complete_is_refused() -> None:
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.3, (8, 8), t_max=50.0)
    forward, backward = compute_map(spec), compute_map(replace(spec, backward=True))
    with pytest.raises(ValueError, match="not complete"):
        join_origin_fates(replace(forward, complete=False), backward)


def test_cancelling_stops_it() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        compute_origin_fates(MapSpec(CASES["III"], Plane.X_PX, 0.26), cancel)
