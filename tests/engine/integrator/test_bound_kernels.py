"""Potentials of one structure share generated code."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from engine.integrator import bound_kernels
from engine.integrator.source.recurrence import CodeOutline, Structure, find_structure, outline_code
from engine.integrator.source.series import Setting
from tests.waiting import SECONDS

TERMS = ((2, 0, 0.5), (0, 2, 0.5))


def test_potentials_of_one_structure_share_code_with_their_own_coefficients() -> None:
    kernels = [bound_kernels.load_kernels(((2, 0, c), (0, 2, 0.5)), Setting()) for c in (0.5, 0.7)]
    assert [module.potential_value(2.0, 1.0) for module in kernels] == [2.5, 0.7 * 4 + 0.5]
    assert kernels[0].potential_value.function is kernels[1].potential_value.function


def test_a_potential_of_the_same_powers_may_need_other_functions() -> None:
    weak, strong = (((2, 0, 0.5), (0, 2, 0.5), (2, 2, c)) for c in (-0.1, 1e6))
    kernels = bound_kernels.load_kernels(weak, Setting())
    _ = kernels.potential_value(0.1, 0.2)
    assert bound_kernels.is_compiled(find_structure(weak, Setting()), ["potential_value"])
    assert not bound_kernels.is_compiled(find_structure(strong, Setting()), ["potential_value"])


def test_known_functions_are_available_while_others_are_generated(monkeypatch: pytest.MonkeyPatch) -> None:
    bound_kernels.load_kernels(TERMS, Setting())
    begun, end = threading.Event(), threading.Event()

    def wait(structure: Structure) -> CodeOutline:
        begun.set()
        assert end.wait(SECONDS)
        return outline_code(structure)

    monkeypatch.setattr(bound_kernels, "find_outline", wait)
    with ThreadPoolExecutor(2) as threads:
        other = threads.submit(bound_kernels.load_kernels, (*TERMS, (11, 0, 0.1)), Setting())
        assert begun.wait(SECONDS)
        known = threads.submit(bound_kernels.load_kernels, ((2, 0, 0.8), (0, 2, 0.5)), Setting())
        try:
            assert known.result(SECONDS).potential_value(1.0, 0.0) == 0.8
        finally:
            end.set()
        assert other.result(SECONDS).potential_value(1.0, 0.0) == 0.6
