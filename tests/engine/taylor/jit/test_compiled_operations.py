"""Compiled code is limited in its amount, since it is never unloaded."""

from __future__ import annotations

import pytest

from engine.taylor import bound_kernels
from engine.taylor.jit.compiled_operations import CompiledOperations
from engine.taylor.source.recurrence import generate_code


def test_compilation_beyond_the_limit_is_refused_with_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    counted = CompiledOperations()
    monkeypatch.setattr(bound_kernels, "compiled_operations", counted)
    terms = ((2, 0, 0.5), (0, 2, 0.5), (9, 0, 1.0))
    counted.most = 1
    with pytest.raises(ValueError, match="choose a potential with the same powers"):
        bound_kernels.load_kernels(terms, 0)
    counted.most = None
    assert bound_kernels.load_kernels(terms, 0).potential_value(1.0, 1.0) == 2.0
    assert counted.used == generate_code(terms, 0).operations


def test_compiled_code_can_be_used_at_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    counted = CompiledOperations()
    monkeypatch.setattr(bound_kernels, "compiled_operations", counted)
    first = bound_kernels.load_kernels(((2, 0, 0.5), (0, 2, 0.5), (0, 9, 1.0)), 0)
    assert first.potential_value(1.0, 0.0) == 0.5
    counted.most = counted.used
    other = bound_kernels.load_kernels(((2, 0, 0.25), (0, 2, 0.5), (0, 9, 1.0)), 0)
    assert other.potential_value(1.0, 0.0) == 0.25
