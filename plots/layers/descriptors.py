"""The layer of Lagrangian descriptors. Its picture shows where neighbouring orbits separate."""

from __future__ import annotations

import numpy as np

from engine import EscapeMap, Fate, MapSpec, TimeDirection, compute_lagrangian_descriptor
from engine.jobs.job import Job
from engine.maps.analyses.descriptors import DEFAULT_DURATION, checked_choices
from engine.maps.map_jobs import map_job
from engine.results import DescriptorMap
from plots.layers.layer import Layer, Pixels
from plots.layers.picture import ColourScale, Legend, Picture, ShownMap
from plots.pictures.image_columns import FIRST_CLASS, pixel_codes
from plots.pictures.palette import Palette, value_colours
from plots.pictures.setting import Setting, Settings

# Number of classes of values, of equal width. Their codes and the codes of other pixels fit into uint8.
_CLASSES = 240
# Share of the values below the scale, and equal share above the scale. They are drawn in the colours of its ends.
_CLIPPED_SHARE = 0.01

DURATION = Setting(
    name="descriptor_time",
    title="Time of the descriptor",
    word="τ",
    choices={f"{time:g}": time for time in (5.0, DEFAULT_DURATION, 20.0, 40.0)},
    default=DEFAULT_DURATION,
    help="Time τ of the Lagrangian descriptor, in units of time of the well.",
)
POWER = Setting(
    name="descriptor_power",
    title="Exponent of the descriptor",
    word="p",
    choices={f"{power:g}": power for power in (0.25, 0.5, 1.0)},
    default=0.5,
    help="Exponent p of the speed in the Lagrangian descriptor, above 0 and at most 1.",
)
DIRECTION = Setting(
    name="descriptor_direction",
    title="Direction of time of the descriptor",
    word="",
    choices={str(direction): direction for direction in TimeDirection},
    default=TimeDirection.BOTH,
    help="Direction of time of the Lagrangian descriptor.",
)


def _job(spec: MapSpec, settings: Settings) -> Job[DescriptorMap]:
    duration = DURATION.value_in(settings) * spec.potential.units.time
    choices = checked_choices(spec.potential, duration, POWER.value_in(settings), DIRECTION.value_in(settings))
    return Job(compute_lagrangian_descriptor, (map_job(spec),), tuple(choices.items()))


def _colours(palette: Palette) -> list[str]:
    return [*palette.outcome_colours, *value_colours(_CLASSES)]


def _limits(values: np.ndarray) -> tuple[float, float]:
    """Return the ends of the scale. Few pixels have values beyond the ends."""
    values = values[np.isfinite(values)]
    if not values.size:
        return 0.0, 1.0
    low, high = np.quantile(values, (_CLIPPED_SHARE, 1.0 - _CLIPPED_SHARE)).tolist()
    return (low, high) if low < high else (low, low + 1.0)


def _codes(result: DescriptorMap, frame: EscapeMap | None) -> np.ndarray:
    """Return the codes of the pixels. Pixels without a value have the code of their fate, if it needs no orbit."""
    values = result.descriptor
    low, high = _limits(values)
    is_known = np.isfinite(values)
    share = (np.clip(np.where(is_known, values, low), low, high) - low) / (high - low)
    fate = np.full(values.shape, Fate.NOT_COMPUTED) if frame is None else frame.fate
    fate_without_value = np.where((fate == Fate.FORBIDDEN) | (fate == Fate.OUTSIDE), fate, Fate.NOT_COMPUTED)
    classes = np.minimum((share * _CLASSES).astype(int), _CLASSES - 1)
    # `pixel_codes` keeps the classes of bounded pixels, so all pixels with a value are passed as bounded.
    return pixel_codes(np.where(is_known, Fate.BOUNDED, fate_without_value), classes, bounded_too=True)


def _legend(shown: ShownMap) -> Legend:
    """Return the legend of a map with a result; "…" until there is one."""
    result = shown.results.get("descriptor")
    if result is None:
        return Legend(sentence="…")
    others = [entry for fate, entry in shown.outcome_entries().items() if fate in {Fate.FORBIDDEN, Fate.OUTSIDE}]
    low, high = (float(f"{end:.3g}") for end in _limits(result.descriptor))
    return Legend(others=others, scale=ColourScale(low, high, value_colours(_CLASSES), is_logarithmic=False))


DESCRIPTORS = Layer(
    name="descriptor",
    title="Lagrangian descriptor",
    help="Integrate a power of the speed along each orbit.",
    stage="Lagrangian descriptor",
    result=DescriptorMap,
    job=_job,
    settings=(DURATION, POWER, DIRECTION),
    pixels=Pixels(
        column="descriptor",
        codes=_codes,
        colours=_colours,
        entries=lambda result, palette: [],
        values=lambda result: result.descriptor.astype(np.float32),
        value_name="Lagrangian descriptor",
        # The hover text shows the value itself.
        sentences=[""] * (FIRST_CLASS + _CLASSES),
    ),
    picture=Picture(
        name="descriptors",
        title="Lagrangian descriptor",
        short_title="Descriptor",
        help=(
            "The integral of a power of the speed, |v|ᵖ, along each orbit over a time τ. It changes rapidly where neighbours "
            "separate: forward in time on the stable manifolds of unstable periodic orbits, backward on the unstable ones, in "
            "both directions on both. The integral ends at the exit, so it is small where orbits leave at once."
        ),
        column="descriptor",
        colours=_colours,
        legend=_legend,
    ),
    variables=("descriptor",),
)
"""Integrals of a power of the speed along orbits."""
