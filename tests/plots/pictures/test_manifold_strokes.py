"""First images, and curves that bound a basin, are drawn over what winds around them."""

from __future__ import annotations

import pytest

from engine import CASES, StableManifolds, find_stable_manifolds
from plots.pictures.manifold_strokes import manifold_strokes


@pytest.fixture(scope="module")
def manifolds() -> StableManifolds:
    return find_stable_manifolds(CASES["III"], 0.45, images=2)


def test_first_images_are_in_front_wider_and_with_a_halo(manifolds: StableManifolds) -> None:
    strokes = manifold_strokes(manifolds)
    images = [stroke.arcs[0].image for stroke in strokes]
    assert images == sorted(images, reverse=True)
    assert {stroke.halo_width > 0.0 for stroke in strokes if stroke.arcs[0].image == 1} == {True}
    assert {stroke.halo_width for stroke in strokes if stroke.arcs[0].image == 2} == {0.0}
    assert strokes[-1].width > strokes[0].width


def test_closed_curves_are_in_front_of_the_spirals_around_them(manifolds: StableManifolds) -> None:
    # In case III the first images of channels 1 and 2 are closed, and those of channels 3 and 4 wind around them.
    assert {stroke.channel for stroke in manifold_strokes(manifolds)[-2:]} == {1, 2}


def test_every_arc_is_drawn_once(manifolds: StableManifolds) -> None:
    drawn = [arc for stroke in manifold_strokes(manifolds) for arc in stroke.arcs]
    assert len(drawn) == len(manifolds.arcs) == len(set(map(id, drawn)))
