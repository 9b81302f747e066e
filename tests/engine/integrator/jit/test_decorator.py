"""The file of a kernel contains its subroutines."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from numba import njit

from engine import CASES, find_lyapunov_orbits
from engine.foundations.cache_files import CACHE_VARIABLE
from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.kernels.periodic_shooting import shoot


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


def test_the_code_of_a_kernel_contains_its_subroutines() -> None:
    """Code of the same name in another kernel would replace it and round differently, depending on the order of loading."""
    find_lyapunov_orbits(CASES["I"], 0.2)
    # Compile the kernel anew, because code from the cache cannot be inspected.
    signature = shoot.signatures[0]
    compiled = njit(nogil=True, error_model="numpy", fastmath={"contract"})(shoot.py_func)
    compiled.compile(signature)
    defined = re.findall(r"^define .*", compiled.inspect_llvm(signature), re.MULTILINE)
    assert len(defined) > 1
    assert not [line for line in defined if "_turning_point" in line or "find_wall" in line]
