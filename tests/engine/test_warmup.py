"""Compilation ahead of time."""

from __future__ import annotations

from engine import Potential, prepare_kernels
from engine.taylor.bound_kernels import load_kernels

# Hénon-Heiles with the orientation of the original paper, which no other test compiles completely.
POTENTIAL = Potential("rotated", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 1.0), (0, 3, -1 / 3)))


def test_all_kernels_are_compiled() -> None:
    prepare_kernels(POTENTIAL)
    kernels = load_kernels(POTENTIAL.terms, POTENTIAL.channels)
    for name in (
        "propagate",
        "jets",
        "tangent",
        "record_steps",
        "shoot",
        "birkhoff_averages",
        "find_section_points",
        "fixed_step_sali",
    ):
        assert getattr(kernels, name).signatures, name
