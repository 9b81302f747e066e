"""Kernels and their subroutines."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.taylor.jit.decorator import kernel, subroutine
from engine.taylor.jit.kernel_files import CACHE_VARIABLE


@subroutine
def twice(x):
    return 2.0 * x


@kernel
def four_times(x):
    return twice(twice(x))


def test_a_subroutine_is_part_of_the_file_of_its_kernel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    assert four_times(1.5) == 6.0
    (file,) = (tmp_path / "kernels").iterdir()
    assert "four_times" in file.name


def test_a_subroutine_can_be_called_from_python() -> None:
    assert twice(1.5) == 3.0
