"""Certified maps against maps with full integration: no orbit that escapes may be certified."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from engine import CASES, Certificate, EscapeMap, Fate, MapSpec, Plane, compute_map

EARLY = (Certificate.CLOSED, Certificate.QUASI_PERIODIC, Certificate.ENCLOSED, Certificate.MIRRORED)
# Mostly regular; sticky, with slow escapes; on a plane where starts are not on the section; many energies.
MAPS = [
    ("III", 0.26, Plane.X_PX),
    ("I", 0.13, Plane.X_PX),
    ("III", 0.35, Plane.X_Y),
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

        _, full = map_pair(*where)
        assert set(np.unique(full.certificate)) <= {Certificate.NONE, Certificate.INTEGRATED, Certificate.MIRRORED}


def test_most_bounded_orbits_of_a_mostly_regular_map_are_certified() -> None:
    certified, _ = map_pair(*MAPS[0])
    bounded = certified.fate == Fate.BOUNDED
    assert bounded.sum() > 170
    assert np.mean(np.isin(certified.certificate[bounded], EARLY)) > 0.9


def test_maps_that_end_before_the_first_test_are_integrated_in_full() -> None:
    result = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.26, (20, 20), t_max=1000.0))
    assert set(np.unique(result.certificate)) <= {Certificate.NONE, Certificate.INTEGRATED, Certificate.MIRRORED}
