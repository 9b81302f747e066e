"""Maps are computed once, and what is found in them is the engine's."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError

import numpy as np
import pytest

from engine import CASES, EscapeMap, MapSpec, Plane, compute_map, compute_regularity
from reproduction.map_shelf import MapShelf
from reproduction.paper_ranges import curve_energies, nine_energies
from reproduction.quality import Quality

TINY = Quality("tiny", resolution=11, t_max=300.0, curve_points=7, hunt_resolution=9, hunt_t_max=2000.0)


def test_a_map_is_computed_once() -> None:
    made: list[EscapeMap] = []
    shelf = MapShelf(TINY, on_map=made.append)
    assert shelf.map("I", Plane.X_PX, 0.2) is shelf.map("I", Plane.X_PX, 0.2)
    assert [frame.spec for frame in made] == [MapSpec(CASES["I"], Plane.X_PX, 0.2, (11, 11), t_max=300.0)]


def test_curves_are_the_shares_of_the_maps_and_keep_none_of_them() -> None:
    made: list[EscapeMap] = []
    shelf = MapShelf(TINY, on_map=made.append)
    table = shelf.curves("II", Plane.X_PX)
    energies = curve_energies("II", 7)
    assert table["h"].values.tolist() == list(energies)
    assert shelf.curves("II", Plane.X_PX) is table
    frame = shelf.map("II", Plane.X_PX, energies[2])
    shares = frame.fractions()
    assert table["share"].values[2].tolist() == [shares[code] for code in (0, 1, 2, 3)]
    assert len(made) == 8


def test_curves_take_maps_that_are_there() -> None:
    made: list[EscapeMap] = []
    shelf = MapShelf(TINY, on_map=made.append)
    shelf.map("I", Plane.X_PX, nine_energies("I")[0])
    shelf.curves("I", Plane.X_PX)
    assert len(made) == 7


def test_the_hunt_is_that_of_a_map_of_its_own_resolution() -> None:
    shelf = MapShelf(TINY)
    hunt = shelf.hunt()
    frame = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.26, (9, 9), t_max=300.0))
    assert (hunt.spec, hunt.t_max) == (frame.spec, 2000.0)
    assert hunt.fate.size == np.count_nonzero(compute_regularity(frame).character == 2)
    assert shelf.hunt() is hunt


def test_a_stopped_shelf_gives_no_half_made_map() -> None:
    cancel = threading.Event()
    cancel.set()
    shelf = MapShelf(TINY, cancel=cancel)
    with pytest.raises(CancelledError):
        shelf.map("I", Plane.X_PX, 0.13)
