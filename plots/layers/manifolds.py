"""The layer of the stable manifolds of the Lyapunov orbits, drawn as curves over other pictures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine import MapSpec, find_stable_manifolds
from engine.jobs.job import Job
from engine.results import StableManifolds
from engine.trajectories.stable_manifolds import MOST_IMAGES, ManifoldArc, section_of_starts
from plots.layers.layer import Count, Layer, Over, Stroke
from plots.pictures.palette import Entry, Mark, Palette
from plots.pictures.setting import Setting, Settings

# Number of images that the page computes. Later images are closer together than a pixel.
_IMAGES = 3

# Widths of the first, the second and all later images, in pixels: later images lie closer together.
_WIDTHS = (1.6, 1.0, 0.6)
# Opacities of the first, the second and all later images.
_ALPHAS = (1.0, 0.9, 0.6)
# Width of the halo on each side of a line, in pixels.
_HALO_RIM = 0.8

IMAGE = Setting(
    name="images",
    title="Image of the manifolds",
    word="Image",
    choices={**{str(image): image for image in range(1, _IMAGES + 1)}, "all": 0},
    default=0,
)
"""The number of the drawn image; 0 for all images."""


def manifold_strokes(manifolds: StableManifolds) -> list[Stroke]:
    """Return the manifolds from back to front.

    Earlier images are in front of later images. Only the first image has a halo. Within an image, shorter curves are in front: a
    closed curve around a basin stays visible although spirals of other channels wind around this curve within a pixel.
    """
    groups: dict[tuple[int, int], list[ManifoldArc]] = {}
    for arc in manifolds.arcs:
        groups.setdefault((arc.image, arc.channel), []).append(arc)
    order = sorted(groups, key=lambda key: (-key[0], -sum(map(_length, groups[key]))))
    return [_stroke(channel, image, groups[image, channel]) for image, channel in order]


def select_image(manifolds: StableManifolds, image: int) -> StableManifolds:
    """Return the arcs of one image, or of all images for 0."""
    if image == 0:
        return manifolds
    return replace(manifolds, arcs=tuple(arc for arc in manifolds.arcs if arc.image == image))


def _stroke(channel: int, image: int, arcs: list[ManifoldArc]) -> Stroke:
    index = min(image, len(_WIDTHS)) - 1
    halo_width = _WIDTHS[index] + 2.0 * _HALO_RIM if image == 1 else 0.0
    lines = tuple(np.column_stack([arc.x, arc.ordinate]) for arc in arcs)
    return Stroke(lambda palette: palette.channels[channel - 1], lines, _WIDTHS[index], halo_width, _ALPHAS[index])


def _length(arc: ManifoldArc) -> float:
    return float(np.hypot(np.diff(arc.x), np.diff(arc.ordinate)).sum())


def _entries(manifolds: StableManifolds, palette: Palette) -> list[Entry]:
    channels = sorted({arc.channel for arc in manifolds.arcs})
    return [Entry(f"stable manifold {k}", palette.channels[k - 1], Mark.LINE, group="manifolds") for k in channels]


def _job(spec: MapSpec, settings: Settings) -> Job[StableManifolds]:
    section = section_of_starts(spec.plane, spec.section)
    options = ("images", settings.get(MANIFOLDS.name, _IMAGES)), ("window", spec.given_window), ("section", section)
    return Job(find_stable_manifolds, (spec.potential, spec.common_energy), options)


def _spec_of(manifolds: StableManifolds) -> MapSpec:
    section = manifolds.section
    return MapSpec(manifolds.potential, section.slice_of_starts, manifolds.energy, section=section)


def _refusal(spec: MapSpec) -> str:
    if spec.backward:
        return "Stable manifolds are drawn on maps forward in time only."
    if section_of_starts(spec.plane, spec.section) is None:
        return (
            "Stable manifolds are drawn on slices whose starts cross a line, such as (x, px) for y = 0 and (y, py) for x = 0; "
            f"{spec.plane.title} is not such a slice."
        )
    if not spec.potential.escapes_over_saddles:
        return "Stable manifolds belong to exits over saddles; orbits of this system escape at a circle."
    return ""


MANIFOLDS = Layer(
    name="manifolds",
    title="Stable manifolds",
    help="Number of images of the stable manifolds, on slices of a section such as x_px; 0 for none.",
    stage="stable manifolds",
    result=StableManifolds,
    job=_job,
    refusal=_refusal,
    count=Count("IMAGES", MOST_IMAGES),
    settings=(IMAGE,),
    select=lambda manifolds, settings: select_image(manifolds, IMAGE.value_in(settings)),
    spec_of=_spec_of,
    over=Over(pictures=("curves", "basins", "crossings"), legend=_entries, strokes=manifold_strokes),
    has_table=True,
)
"""Curves between orbits that escape and orbits that turn back."""
