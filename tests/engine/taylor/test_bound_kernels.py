from __future__ import annotations

from engine import CASES
from engine.taylor import bound_kernels

TERMS = ((2, 0, 0.5), (0, 2, 0.5))


def test_other_exponents_or_channels_are_another_module() -> None:
    modules = [
        bound_kernels.load_kernels(TERMS, 0),
        bound_kernels.load_kernels(TERMS, 1),
        bound_kernels.load_kernels(((2, 0, 0.5),), 0),
    ]
    assert len({module.__name__ for module in modules}) == 3


def test_each_potential_has_its_own_coefficients_in_shared_code() -> None:
    kernels = [bound_kernels.load_kernels(((2, 0, c), (0, 2, 0.5)), 0) for c in (0.5, 0.7)]
    assert [module.potential_value(2.0, 1.0) for module in kernels] == [2.5, 0.7 * 4 + 0.5]
    assert kernels[0].potential_value.function is kernels[1].potential_value.function


def test_kernels_of_a_potential_are_loaded_once() -> None:
    first = bound_kernels.load_kernels(CASES["I"].terms, 2)
    assert bound_kernels.load_kernels(CASES["I"].terms, 2) is first
