"""No orbit that escapes in full integration is ever certified."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from engine import CASES, Certificate, EscapeMap, Fate, MapSpec, Plane, compute_map, describe_certificate

EARLY = (Certificate.CLOSED, Certificate.QUASI_PERIODIC, Certificate.ENCLOSED, Certificate.MIRRORED)
# Mostly regular; sticky, with slow escapes; islands only; on the other plane, where starts are not on the section.
MAPS = [
    ("III", 0.26, Plane.X_PX),
    ("I", 0.13, Plane.X_PX),
    ("III", 0.35, Plane.X_Y),
    ("II", 0.18, Plane.X_PX),
    ("III", (0.25, 0.5), Plane.X_H),
]


@cache
def both(name: str, energy: float, plane: Plane) -> tuple[EscapeMap, EscapeMap]:
    """With certificates and without."""
    spec = MapSpec(CASES[name], plane, energy, (31, 31), t_max=3e4)
    return compute_map(spec), compute_map(replace(spec, certify=False))


@pytest.mark.slow
@pytest.mark.parametrize("where", MAPS, ids=str)
class TestCertificates:
    def test_nothing_certified_escapes(self, where: tuple) -> None:
        certified, whole = both(*where)
        early = np.isin(certified.certificate, EARLY)
        assert np.all(whole.fate[early] == Fate.BOUNDED)

    def test_everything_else_is_equal_to_the_bit(self, where: tuple) -> None:
        certified, whole = both(*where)
        np.testing.assert_array_equal(certified.fate, whole.fate)
        np.testing.assert_array_equal(certified.escape_time, whole.escape_time)
        escaped = whole.fate >= 1
        np.testing.assert_array_equal(certified.crossings[escaped], whole.crossings[escaped])

    def test_bounded_pixels_and_no_others_say_why(self, where: tuple) -> None:
        for result in both(*where):
            np.testing.assert_array_equal(result.certificate != Certificate.NONE, result.fate == Fate.BOUNDED)

    def test_without_certificates_all_are_followed(self, where: tuple) -> None:
        _, whole = both(*where)
        assert set(np.unique(whole.certificate)) <= {Certificate.NONE, Certificate.INTEGRATED, Certificate.MIRRORED}


@pytest.mark.slow
def test_nearly_all_of_a_mostly_regular_map_is_certified() -> None:
    certified, _ = both(*MAPS[0])
    bounded = certified.fate == Fate.BOUNDED
    assert bounded.sum() > 400
    assert np.mean(np.isin(certified.certificate[bounded], EARLY)) > 0.9


def test_below_the_escape_energy_nothing_needs_to_be_followed() -> None:
    result = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.16, (40, 40), t_max=1e8))
    bounded = result.fate == Fate.BOUNDED
    assert set(result.certificate[bounded]) == {Certificate.CLOSED}
    assert not np.any(result.fate >= 1)


def test_short_maps_are_followed_in_full() -> None:
    result = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.26, (20, 20), t_max=2000.0))
    assert set(np.unique(result.certificate)) <= {Certificate.NONE, Certificate.INTEGRATED, Certificate.MIRRORED}


def test_a_certified_map_goes_on_to_a_later_t_max() -> None:
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.28, (21, 21), t_max=1e4)
    later = replace(spec, t_max=4e4)
    resumed, straight = compute_map(later, resume=compute_map(spec)), compute_map(later)
    np.testing.assert_array_equal(resumed.fate, straight.fate)
    np.testing.assert_array_equal(resumed.escape_time, straight.escape_time)


def test_certificates_are_written_to_the_dataset() -> None:
    dataset = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.1, (8, 8), t_max=1e4)).to_xarray()
    assert "2: closed" in dataset["certificate"].attrs["codes"]
    assert dataset.attrs["certify"] == 1


def test_every_certificate_has_words_of_its_own() -> None:
    assert len({describe_certificate(code) for code in Certificate}) == len(Certificate)
