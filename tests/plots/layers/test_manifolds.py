"""First images, and curves around a basin, are drawn over the spirals around them."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, find_stable_manifolds
from engine.results import StableManifolds
from plots.layers.manifolds import manifold_strokes
from plots.pictures.palette import PAPER


@pytest.fixture(scope="module")
def manifolds() -> StableManifolds:
    return find_stable_manifolds(CASES["III"], 0.45, images=2)


def test_first_images_are_in_front_wider_and_with_a_halo(manifolds: StableManifolds) -> None:
    strokes = manifold_strokes(manifolds)
    image_of = {(arc.x[0], arc.ordinate[0]): arc.image for arc in manifolds.arcs}
    images = [image_of[tuple(stroke.lines[0][0])] for stroke in strokes]
    assert images == sorted(images, reverse=True)
    assert {(image, stroke.halo_width > 0.0) for image, stroke in zip(images, strokes, strict=True)} == {(1, True), (2, False)}
    assert strokes[-1].width > strokes[0].width


def test_closed_curves_are_in_front_of_the_spirals_around_them(manifolds: StableManifolds) -> None:
    # In case III the first images of channels 1 and 2 are closed, and those of channels 3 and 4 wind around them.
    assert {stroke.colour(PAPER) for stroke in manifold_strokes(manifolds)[-2:]} == set(PAPER.channels[:2])


def test_every_arc_is_drawn_once(manifolds: StableManifolds) -> None:
    drawn = [line.tobytes() for stroke in manifold_strokes(manifolds) for line in stroke.lines]
    assert sorted(drawn) == sorted(np.column_stack([arc.x, arc.ordinate]).tobytes() for arc in manifolds.arcs)
