"""Maps and analyses are computed once."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError

import numpy as np
import pytest

from engine import CASES, EscapeMap, MapSpec, Plane, compute_map, compute_regularity
from engine.foundations.execution import Execution
from reproduction.map_cache import MapCache
from reproduction.paper_ranges import curve_energies, nine_energies
from reproduction.quality import Quality

TINY = Quality(
    "tiny", resolution=11, t_max=300.0, curve_points=7, search_resolution=9,
    search_t_max=2000.0, classified_resolution=10, exponent_work=1e4,
)  # fmt: skip


def test_a_map_is_computed_once() -> None:
    computed: list[EscapeMap] = []
    cache = MapCache(TINY, on_map=computed.append)
    assert cache.map("I", Plane.X_PX, 0.2) is cache.map("I", Plane.X_PX, 0.2)
    assert [frame.spec for frame in computed] == [MapSpec(CASES["I"], Plane.X_PX, 0.2, (11, 11), t_max=300.0)]


def test_curves_are_the_shares_of_maps_that_are_not_stored() -> None:
    computed: list[EscapeMap] = []
    cache = MapCache(TINY, on_map=computed.append)
    table = cache.curves("II", Plane.X_PX)
    energies = curve_energies("II", 7)
    assert table.values.tolist() == list(energies)
    assert cache.curves("II", Plane.X_PX) is table
    frame = cache.map("II", Plane.X_PX, energies[2])
    shares = frame.fractions()
    assert table["share"][2].tolist() == [shares[code] for code in (0, 1, 2, 3)]
    assert len(computed) == 8


def test_curves_use_stored_maps() -> None:
    computed: list[EscapeMap] = []
    cache = MapCache(TINY, on_map=computed.append)
    cache.map("I", Plane.X_PX, nine_energies("I")[0])
    cache.curves("I", Plane.X_PX)
    assert len(computed) == 7


def test_the_super_sticky_search_has_its_own_resolution() -> None:
    cache = MapCache(TINY)
    search = cache.super_sticky()
    frame = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.26, (9, 9), t_max=300.0))
    assert (search.spec, search.t_max) == (frame.spec, 2000.0)
    assert search.fate.size == np.count_nonzero(compute_regularity(frame).character == 2)
    assert cache.super_sticky() is search


def test_a_cancelled_cache_returns_no_incomplete_map() -> None:
    cancel = threading.Event()
    cancel.set()
    cache = MapCache(TINY, execution=Execution(cancel=cancel))
    with pytest.raises(CancelledError):
        cache.map("I", Plane.X_PX, 0.13)
