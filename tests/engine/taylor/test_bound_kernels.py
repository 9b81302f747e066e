from __future__ import annotations

from engine import CASES
from engine.taylor import bound_kernels

TERMS = ((2, 0, 0.5), (0, 2, 0.5))


def test_other_exponents_or_another_number_of_channels_give_another_module() -> None:
    modules = [
        bound_kernels.load_kernels(TERMS, 0),
        bound_kernels.load_kernels(TERMS, 1),
        bound_kernels.load_kernels(((2, 0, 0.5),), 0),
    ]
    assert len({module.__name__ for module in modules}) == 3


def test_potentials_of_one_structure_share_code_with_their_own_coefficients() -> None:
    kernels = [bound_kernels.load_kernels(((2, 0, c), (0, 2, 0.5)), 0) for c in (0.5, 0.7)]
    assert [module.potential_value(2.0, 1.0) for module in kernels] == [2.5, 0.7 * 4 + 0.5]
    assert kernels[0].potential_value.function is kernels[1].potential_value.function


def test_kernels_of_a_potential_are_cached() -> None:
    first = bound_kernels.load_kernels(CASES["I"].terms, 2)
    assert bound_kernels.load_kernels(CASES["I"].terms, 2) is first
