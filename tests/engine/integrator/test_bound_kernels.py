from __future__ import annotations

from engine.integrator import bound_kernels

TERMS = ((2, 0, 0.5), (0, 2, 0.5))


def test_potentials_of_one_structure_share_code_with_their_own_coefficients() -> None:
    kernels = [bound_kernels.load_kernels(((2, 0, c), (0, 2, 0.5)), 0) for c in (0.5, 0.7)]
    assert [module.potential_value(2.0, 1.0) for module in kernels] == [2.5, 0.7 * 4 + 0.5]
    assert kernels[0].potential_value.function is kernels[1].potential_value.function
