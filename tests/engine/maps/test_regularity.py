from __future__ import annotations

import threading
from itertools import pairwise

import numpy as np
import pytest

from engine import CASES, Fate, MapSpec, Plane, Regularity, compute_map, compute_regularity, integrate_orbit, start_states


def judged(name: str, energy: float, side: int = 9, t_max: float = 1e4):
    whole = compute_map(MapSpec(CASES[name], Plane.X_PX, energy, (side, side), t_max=t_max))
    return whole, compute_regularity(whole)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "energy"), [("I", 0.12), ("III", 0.27)])
def test_the_map_agrees_with_sali_of_single_orbits(name: str, energy: float) -> None:
    whole, regularity = judged(name, energy)
    rows, columns = np.nonzero(whole.fate == Fate.BOUNDED)
    states = start_states(CASES[name], Plane.X_PX, energy, whole.x[columns], whole.ordinate[rows])
    chaotic = np.array([integrate_orbit(CASES[name], state, 1e4).regularity is Regularity.CHAOTIC for state in states])
    mine = regularity.character[rows, columns] == Regularity.CHAOTIC
    # An orbit on the verge may fall just before t_max or just after.
    assert np.sum(mine != chaotic) <= 2
    assert chaotic.any()
    assert not chaotic.all()


def test_every_bounded_pixel_and_no_other_is_judged() -> None:
    whole, regularity = judged("III", 0.28)
    assert regularity.complete
    np.testing.assert_array_equal(
        np.isin(regularity.character, (Regularity.REGULAR, Regularity.CHAOTIC)), whole.fate == Fate.BOUNDED
    )


def test_all_of_a_nearly_harmonic_well_is_regular() -> None:
    _, regularity = judged("I", 0.01)
    assert regularity.chaotic_share == 0.0


def test_a_map_without_bounded_orbits_has_no_chaotic_share() -> None:
    _, regularity = judged("II", 0.3)
    assert regularity.complete
    assert np.isnan(regularity.chaotic_share)


def test_short_maps_are_judged_by_sali_at_t_max() -> None:
    _, regularity = judged("II", 0.16, t_max=400.0)
    assert set(np.unique(regularity.character)) == {Regularity.NO_QUESTION, Regularity.REGULAR, Regularity.CHAOTIC}


def test_frames_only_ever_add_to_what_is_known() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.16, (13, 13), t_max=2e4))
    frames = []
    compute_regularity(whole, frames.append)
    for before, after in pairwise(frames):
        known = before.character != Regularity.NOT_JUDGED
        np.testing.assert_array_equal(before.character[known], after.character[known])


def test_when_cancelled_the_rest_is_not_judged() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.16, (13, 13), t_max=2e4))
    cancel = threading.Event()
    cancel.set()
    result = compute_regularity(whole, cancel=cancel)
    assert not result.complete
    assert Regularity.NOT_JUDGED in result.character


def test_an_unfinished_map_is_refused() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(ValueError, match="not complete"):
        compute_regularity(compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.2, (9, 9)), cancel=cancel))
