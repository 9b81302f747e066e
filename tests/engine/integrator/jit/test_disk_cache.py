"""Processes share compiled kernels on disk."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from loky import ProcessPoolExecutor

from engine.foundations.cache_files import CACHE_VARIABLE
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.jit.code_outlines import find_outline
from engine.integrator.jit.compiling_process import compile_in
from engine.integrator.jit.webassembly import webassembly_module
from engine.integrator.source.recurrence import find_structure, generate_code
from engine.integrator.source.series import Setting
from tests.waiting import SECONDS


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Yield the folder of the files of an empty cache."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    yield tmp_path / "kernels"
    compile_in(None)


def count_generated() -> int:
    """Return how often this process has generated code."""
    return generate_code.cache_info().misses


def test_another_process_generates_and_compiles(folder: Path) -> None:
    before = count_generated()
    with ProcessPoolExecutor(1) as other:

        def call_there(call: Callable[[], Any]) -> Any:
            return other.submit(call).result(SECONDS)

        compile_in(call_there)
        terms = ((2, 0, 0.5), (0, 2, 0.5), (6, 1, 1.0))
        potential_value = load_kernels(terms, Setting()).potential_value
        assert potential_value(2.0, 1.0) == 2.0 + 0.5 + 2.0**6
        # Other kernels call it by its address.
        assert potential_value.function.address > 0
        _ = webassembly_module(find_outline(find_structure(terms, Setting())))
    assert stored_names(folder) == ["code_outlines", "potential_value", "webassembly"]
    assert count_generated() == before


def stored_names(folder: Path) -> list[str]:
    """Return the names of what is stored, in alphabetical order, without modules and hashes."""
    found = (
        name for name in ("code_outlines", "potential_value", "webassembly") for file in folder.iterdir() if name in file.name
    )
    return sorted(found)


def test_code_that_is_stored_is_not_generated_again(folder: Path) -> None:
    structure = find_structure(((2, 0, 0.5), (0, 2, 0.5), (1, 7, 1.0)), Setting())
    outline, before = find_outline(structure), count_generated()
    assert find_outline(structure) == outline
    assert count_generated() == before


def test_this_process_compiles_kernels_that_the_other_process_cannot(folder: Path) -> None:
    compile_in(None)
    terms = ((2, 0, 0.5), (0, 2, 0.5), (1, 6, 1.0))
    find_outline(find_structure(terms, Setting()))
    compile_in(refuse)
    assert load_kernels(terms, Setting()).potential_value(2.0, 1.0) == 2.0 + 0.5 + 2.0
    assert stored_names(folder) == ["code_outlines", "potential_value"]


def test_code_that_the_other_process_cannot_generate_is_refused(folder: Path) -> None:
    compile_in(refuse)
    with pytest.raises(ValueError, match="it takes too long"):
        load_kernels(((2, 0, 0.5), (0, 2, 0.5), (1, 8, 1.0)), Setting())
    assert not folder.exists()


def refuse(_: Callable[[], object]) -> None:
    """Refuse every call."""
    raise ValueError("it takes too long")
