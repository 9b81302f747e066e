from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, EscapeMap, MapSpec, Plane, compute_map
from engine.maps.pixels import MirrorPixels, PixelCodes, code_share

PENDING, DECIDED = 3, 1


@pytest.fixture
def symmetric_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.4, (4, 3), t_max=20.0))


def mirror_pixels(name: str) -> MirrorPixels:
    spec = MapSpec(CASES[name], Plane.X_PX, 0.4, (4, 3))
    return MirrorPixels(spec, *spec.pixel_centres())


def test_partner_of_a_symmetric_map_is_the_rotated_pixel() -> None:
    mirror = mirror_pixels("III")
    assert mirror.symmetric
    np.testing.assert_array_equal(mirror.partner, np.arange(12)[::-1])


def test_partner_without_symmetry_is_the_pixel_itself() -> None:
    mirror = mirror_pixels("I")
    assert not mirror.symmetric
    np.testing.assert_array_equal(mirror.partner, np.arange(12))
    np.testing.assert_array_equal(mirror.firsts_among(np.arange(12)), np.arange(12))


def test_first_pixels_of_pairs() -> None:
    mirror = mirror_pixels("III")
    np.testing.assert_array_equal(mirror.firsts_among(np.array([0, 4, 8, 11])), [0, 4])
    np.testing.assert_array_equal(mirror.firsts_of(np.array([4, 8, 10, 11])), [0, 1, 3, 4])


def test_codes_are_complete_when_all_first_pixels_are_decided(symmetric_map: EscapeMap) -> None:
    codes = PixelCodes(symmetric_map, np.full((3, 4), PENDING), PENDING)
    np.testing.assert_array_equal(codes.pixels, np.arange(6))
    codes.assign(codes.pixels[:5], DECIDED)
    before, complete_before = codes.snapshot()
    codes.assign(codes.pixels[5:], DECIDED)
    after, complete_after = codes.snapshot()
    assert (complete_before, complete_after) == (False, True)
    np.testing.assert_array_equal(before.ravel() == PENDING, np.isin(np.arange(12), (5, 6)))
    np.testing.assert_array_equal(after, DECIDED)
    assert not after.flags.writeable


def test_code_share() -> None:
    assert code_share(np.array([1, 2, 2, 3]), 2, 3) == 0.75
    assert np.isnan(code_share(np.empty(0, np.int8), 2))
