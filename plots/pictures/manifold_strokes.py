"""How stable manifolds are drawn: order, widths and opacity of their arcs."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from engine import StableManifolds
from engine.periodic.stable_manifolds import ManifoldArc

# Strokes of the first, the second and all later images, which lie ever closer together.
_WIDTHS, _ALPHAS = (1.6, 1.0, 0.6), (1.0, 0.9, 0.6)
_RIM = 0.8


@dataclass(frozen=True, eq=False)
class Stroke:
    """The arcs of one image of one channel's manifold, and how they are drawn.

    Attributes
    ----------
    channel
        Exit channel, from 1, whose colour the arcs have.
    arcs
        The arcs.
    width, halo_width
        Of the line, and of the light line below it, in pixels; only the first image has such a halo.
    alpha
        Opacity of the line, 0 to 1.
    """

    channel: int
    arcs: tuple[ManifoldArc, ...]
    width: float
    halo_width: float
    alpha: float


def manifold_strokes(manifolds: StableManifolds) -> list[Stroke]:
    """The manifolds from back to front.

    Earlier images are in front of later ones. Of one image, shorter curves are in front: a closed curve that bounds a basin stays
    visible although the spirals of other channels wind around it within a pixel.
    """
    groups: dict[tuple[int, int], list[ManifoldArc]] = {}
    for arc in manifolds.arcs:
        groups.setdefault((arc.image, arc.channel), []).append(arc)
    order = sorted(groups, key=lambda key: (-key[0], -sum(map(_length, groups[key]))))
    return [_stroke(channel, image, groups[image, channel]) for image, channel in order]


def select_image(manifolds: StableManifolds, image: int) -> StableManifolds:
    """The arcs of one image; of all images for 0."""
    if image == 0:
        return manifolds
    return replace(manifolds, arcs=tuple(arc for arc in manifolds.arcs if arc.image == image))


def _stroke(channel: int, image: int, arcs: list[ManifoldArc]) -> Stroke:
    place = min(image, len(_WIDTHS)) - 1
    halo_width = _WIDTHS[place] + 2.0 * _RIM if image == 1 else 0.0
    return Stroke(channel, tuple(arcs), _WIDTHS[place], halo_width, _ALPHAS[place])


def _length(arc: ManifoldArc) -> float:
    return float(np.hypot(np.diff(arc.x), np.diff(arc.px)).sum())
