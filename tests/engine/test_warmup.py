from __future__ import annotations

from engine import Potential, prepare_kernels
from engine.taylor.bound_kernels import load_kernels

# Hénon and Heiles in their own orientation: a potential that no other test compiles in full.
TURNED = Potential("turned", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 1.0), (0, 3, -1 / 3)))


def test_every_kernel_that_a_page_needs_is_compiled_ahead() -> None:
    prepare_kernels(TURNED)
    kernels = load_kernels(TURNED.terms, TURNED.channels)
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
