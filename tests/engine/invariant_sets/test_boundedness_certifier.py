"""Certified maps against maps with full integration: no orbit that escapes may be certified."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from engine import CASES, Certificate, EscapeMap, Fate, MapSpec, Plane, compute_map
from engine.dynamics.certificates import describe_certificate

EARLY = (Certificate.CLOSED, Certificate.QUASI_PERIODIC, Certificate.ENCLOSED, Certificate.MIRRORED)
# Mostly regular; sticky, with slow escapes; on a plane where starts are not on the section; islands only; many energies.
MAPS = [
    ("III", 0.26, Plane.X_PX),
    ("I", 0.13, Plane.X_PX),
    ("III", 0.35, Plane.X_Y),
    ("II", 0.18, Plane.X_PX),
    ("III", (0.25, 0.5), Plane.X_H),
]


@cache
def map_pair(name: str, energy: float, plane: Plane) -> tuple[EscapeMap, EscapeMap]:
    """The map with certificates, and the same map with full integration."""
    spec = MapSpec(CASES[name], plane, energy, (21, 21), t_max=3e4)
    return compute_map(spec), compute_map(replace(spec, certify=False))


@pytest.mark.parametrize("where", MAPS, ids=str)
class TestCertificates:
    def test_certified_orbits_do_not_escape(self, where: tuple) -> None:
        certified, full = map_pair(*where)
        early = np.isin(certified.certificate, EARLY)
        assert np.all(full.fate[early] == Fate.BOUNDED)

    def test_outcomes_are_bit_identical_to_full_integration(self, where: tuple) -> None:
        certified, full = map_pair(*where)
        np.testing.assert_array_equal(certified.fate, full.fate)
        np.testing.assert_array_equal(certified.escape_time, full.escape_time)
        escaped = full.fate >= 1
        np.testing.assert_array_equal(certified.crossings[escaped], full.crossings[escaped])

    def test_exactly_the_bounded_pixels_have_a_certificate(self, where: tuple) -> None:
        for result in map_pair(*where):
            np.testing.assert_array_equal(result.certificate != Certificate.NONE, result.fate == Fate.BOUNDED)

    def test_without_certify_all_bounded_orbits_are_integrated(self, where: tuple) -> None:
        _, full = map_pair(*where)
        assert set(np.unique(full.certificate)) <= {Certificate.NONE, Certificate.INTEGRATED, Certificate.MIRRORED}


def test_most_bounded_orbits_of_a_mostly_regular_map_are_certified() -> None:
    certified, _ = map_pair(*MAPS[0])
    bounded = certified.fate == Fate.BOUNDED
    assert bounded.sum() > 170
    assert np.mean(np.isin(certified.certificate[bounded], EARLY)) > 0.9


def test_below_the_escape_energy_all_bounded_orbits_are_certified_as_closed() -> None:
    result = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.16, (40, 40), t_max=1e8))
    bounded = result.fate == Fate.BOUNDED
    assert set(result.certificate[bounded]) == {Certificate.CLOSED}
    assert not np.any(result.fate >= 1)


def test_maps_that_end_before_the_first_test_are_integrated_in_full() -> None:
    result = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.26, (20, 20), t_max=1000.0))
    assert set(np.unique(result.certificate)) <= {Certificate.NONE, Certificate.INTEGRATED, Certificate.MIRRORED}


def test_certified_map_can_be_resumed_to_a_larger_t_max() -> None:
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.28, (21, 21), t_max=1e4)
    longer = replace(spec, t_max=4e4)
    resumed, direct = compute_map(longer, resume=compute_map(spec)), compute_map(longer)
    np.testing.assert_array_equal(resumed.fate, direct.fate)
    np.testing.assert_array_equal(resumed.escape_time, direct.escape_time)


def test_certificates_are_written_to_the_dataset() -> None:
    dataset = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.1, (8, 8), t_max=1e4)).to_xarray()
    assert "2: closed" in dataset["certificate"].attrs["codes"]
    assert dataset.attrs["certify"] == 1


def test_each_certificate_has_its_own_description() -> None:
    assert len({describe_certificate(code) for code in Certificate}) == len(Certificate)


class RecordingPool(ThreadPoolExecutor):
    """A thread pool that remembers the arguments of its calls."""

    def __init__(self) -> None:
        super().__init__(2)
        self.calls: dict[str, list[tuple[Any, ...]]] = {}

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Any:
        self.calls.setdefault(function.__name__, []).append(arguments)
        return super().submit(function, *arguments, **named)


def test_parallel_calls_share_no_polygons() -> None:
    # GEOS prepares a polygon further at its first use, which two threads must not do at once.
    with RecordingPool() as pool:
        compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.13, (90, 90), t_max=1e4), executor=pool)
    applied = pool.calls["_separated_by_pickled"]
    assert len(applied) > 1
    assert {type(argument) for arguments in applied for argument in arguments} == {bytes, np.ndarray}
