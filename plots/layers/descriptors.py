"""The layer of Lagrangian descriptors. Its picture shows where neighbouring orbits separate."""

from __future__ import annotations

import numpy as np

from engine import MapSpec, TimeDirection, compute_lagrangian_descriptor
from engine.jobs.job import Job
from engine.maps.analyses.descriptors import DEFAULT_DURATION, checked_choices
from engine.maps.map_jobs import map_job
from engine.results import DescriptorMap
from plots.layers.layer import Layer, Pixels
from plots.layers.picture import Legend, Picture, ShownMap
from plots.layers.value_scale import ValueScale
from plots.pictures.setting import Setting, Settings

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


SCALE: ValueScale[DescriptorMap] = ValueScale(lambda result: result.descriptor)
"""The scale of the descriptors."""


def _legend(shown: ShownMap) -> Legend:
    return SCALE.legend(shown, shown.results.get("descriptor"))


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
        codes=SCALE.codes,
        colours=SCALE.colours,
        entries=lambda result, palette: [],
        values=lambda result: result.descriptor.astype(np.float32),
        value_name="Lagrangian descriptor",
        sentences=SCALE.no_sentences,
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
        colours=SCALE.colours,
        legend=_legend,
    ),
    variables=("descriptor",),
)
"""Integrals of a power of the speed along orbits."""
