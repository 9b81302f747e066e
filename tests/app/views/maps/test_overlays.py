"""Overlays have the colours and entries of what they show."""

from __future__ import annotations

import numpy as np
import pytest

from app.views.maps.overlays import Overlays
from engine import CASES, MapSpec, Plane, StableManifolds, Trust, TrustMap, compute_map, compute_trust, find_stable_manifolds
from plots.pictures.palette import COLOUR_BLIND_SAFE, PAPER


@pytest.fixture(scope="module")
def manifolds() -> StableManifolds:
    return find_stable_manifolds(CASES["II"], 0.3, images=1)


@pytest.fixture(scope="module")
def trust() -> TrustMap:
    return compute_trust(compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (60, 60), t_max=500.0)))


def test_manifolds_have_the_colours_of_their_channels_and_entries_while_they_are_drawn(manifolds: StableManifolds) -> None:
    overlays = Overlays()
    overlays.show_manifolds(manifolds)
    for palette in (PAPER, COLOUR_BLIND_SAFE):
        overlays.set_palette(palette)
        assert set(overlays.manifolds.data["colour"]) == set(palette.channels[:3])
        assert [entry.colour for entry in overlays.entries()] == list(palette.channels[:3])
    assert [entry.label for entry in overlays.entries()] == [f"stable manifold of Lyapunov orbit {k}" for k in (1, 2, 3)]
    overlays.show_manifolds(None)
    assert overlays.entries() == []


def test_doubtful_pixels_have_two_tones_an_entry_and_codes_for_the_hover(trust: TrustMap) -> None:
    overlays = Overlays()
    overlays.show_trust(trust)
    tones = overlays.doubts.data["doubt"][0]
    np.testing.assert_array_equal(tones > 0, trust.trust == Trust.DOUBTFUL)
    assert set(np.unique(tones)) == {0, 1, 2}
    np.testing.assert_array_equal(overlays.doubts.data["trust"][0], trust.trust)
    assert [entry.label for entry in overlays.entries()] == ["doubtful pixels"]
    overlays.show_trust(None)
    assert overlays.doubts.data["trust"] == []
