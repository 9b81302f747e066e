"""Maps with evidence agree with maps of full integration, and no orbit with evidence escapes."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from engine import CASES, EscapeMap, Evidence, Fate, MapSpec, Plane, compute_map

EARLY = (Evidence.CLOSED, Evidence.QUASI_PERIODIC, Evidence.ENCLOSED, Evidence.MIRRORED)
# Maps whose orbits are mostly regular; are sticky and escape slowly; do not start on the section; have many energies.
MAPS = [
    ("III", 0.26, Plane.X_PX),
    ("I", 0.13, Plane.X_PX),
    ("III", 0.35, Plane.X_Y),
    ("III", (0.25, 0.5), Plane.X_H),
]


@cache
def map_pair(name: str, energy: float, plane: Plane) -> tuple[EscapeMap, EscapeMap]:
    """Return the map with evidence, and the same map with full integration."""
    spec = MapSpec(CASES[name], plane, energy, (15, 15), t_max=3e4)
    return compute_map(spec), compute_map(replace(spec, use_evidence=False))


@pytest.mark.parametrize("where", MAPS, ids=str)
class TestEvidence:
    def test_orbits_with_evidence_do_not_escape(self, where: tuple) -> None:
        early_map, full = map_pair(*where)
        early = np.isin(early_map.evidence, EARLY)
        assert np.all(full.fate[early] == Fate.BOUNDED)

    def test_outcomes_are_bit_identical_to_full_integration(self, where: tuple) -> None:
        early_map, full = map_pair(*where)
        np.testing.assert_array_equal(early_map.fate, full.fate)
        np.testing.assert_array_equal(early_map.escape_time, full.escape_time)
        escaped = full.fate >= 1
        np.testing.assert_array_equal(early_map.crossings[escaped], full.crossings[escaped])

    def test_exactly_the_bounded_pixels_have_evidence(self, where: tuple) -> None:
        for result in map_pair(*where):
            np.testing.assert_array_equal(result.evidence != Evidence.NONE, result.fate == Fate.BOUNDED)

        _, full = map_pair(*where)
        assert set(np.unique(full.evidence)) <= {Evidence.NONE, Evidence.INTEGRATED, Evidence.MIRRORED}


def test_most_bounded_orbits_of_a_mostly_regular_map_have_evidence() -> None:
    early_map, _ = map_pair(*MAPS[0])
    bounded = early_map.fate == Fate.BOUNDED
    assert bounded.sum() > 85
    assert np.mean(np.isin(early_map.evidence[bounded], EARLY)) > 0.9


def test_maps_that_end_before_the_first_test_are_integrated_in_full() -> None:
    result = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.26, (20, 20), t_max=1000.0))
    assert set(np.unique(result.evidence)) <= {Evidence.NONE, Evidence.INTEGRATED, Evidence.MIRRORED}
