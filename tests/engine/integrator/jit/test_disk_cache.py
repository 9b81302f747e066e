"""Processes share compiled kernels on disk."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from loky import ProcessPoolExecutor

from engine.foundations.cache_files import CACHE_VARIABLE
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.jit.disk_cache import compile_in
from engine.integrator.source.series import Setting
from tests.waiting import SECONDS


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Yield the folder of the files of an empty cache."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    yield tmp_path / "kernels"
    compile_in(None)


def test_this_process_loads_kernels_that_another_process_stored(folder: Path) -> None:
    stored = list[str]()
    with ProcessPoolExecutor(1) as other:

        def compile_there(call: Callable[[], None]) -> None:
            other.submit(call).result(SECONDS)
            stored.extend(file.name for file in folder.iterdir())

        compile_in(compile_there)
        kernels = load_kernels(((2, 0, 0.5), (0, 2, 0.5), (6, 1, 1.0)), Setting())
        assert kernels.potential_value(2.0, 1.0) == 2.0 + 0.5 + 2.0**6
    assert [name.partition(".")[2].partition(".")[0] for name in stored] == ["potential_value"]


def test_this_process_compiles_kernels_that_the_other_process_cannot(folder: Path) -> None:
    def refuse(_: Callable[[], None]) -> None:
        raise ValueError("it takes too long")

    compile_in(refuse)
    kernels = load_kernels(((2, 0, 0.5), (0, 2, 0.5), (1, 6, 1.0)), Setting())
    assert kernels.potential_value(2.0, 1.0) == 2.0 + 0.5 + 2.0
    assert len(list(folder.iterdir())) == 1
