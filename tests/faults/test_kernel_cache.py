"""Compiled kernels on disk: whatever became of them, the next start computes the same."""

from __future__ import annotations

import errno
import logging
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from engine.taylor.jit import disk_cache
from engine.taylor.jit.decorator import kernel
from engine.taylor.jit.disk_cache import CACHE_VARIABLE, ENDING

_PROGRAM = """
import sys
from engine.taylor.jit.decorator import kernel

@kernel
def scaled(x):
    return 3.0 * x

print(scaled(float(sys.argv[1])))
"""


def fresh_kernel() -> Callable[[float], float]:
    """The same function, as a new process would see it."""

    @kernel
    def scaled(x: float) -> float:
        return 3.0 * x

    compiled: Callable[[float], float] = scaled
    return compiled


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    disk_cache._warn_once.cache_clear()
    return tmp_path / "cache" / "kernels"


def hits(compiled: Any) -> int:
    return sum(compiled.stats.cache_hits.values())


def said(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]


def test_a_kernel_is_compiled_once_and_loaded_from_then_on(folder: Path) -> None:
    assert fresh_kernel()(2.0) == 6.0
    (kept,) = folder.iterdir()
    assert kept.suffix == ENDING
    written = kept.stat().st_mtime_ns
    again = fresh_kernel()
    assert again(2.0) == 6.0
    assert hits(again) == 1
    assert kept.stat().st_mtime_ns == written


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: b"",
        lambda content: content[: len(content) // 2],
        lambda content: content[:-1],
        lambda content: b"\x80\x04garbage" * 100,
        lambda content: content[:500] + bytes([content[500] ^ 1]) + content[501:],
        lambda content: content + b"more",
    ],
    ids=["empty", "half", "one byte short", "garbage", "one bit", "longer"],
)
def test_a_damaged_file_is_noticed_and_replaced(
    damage: Callable[[bytes], bytes], folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    fresh_kernel()(2.0)
    (kept,) = folder.iterdir()
    whole = kept.read_bytes()
    kept.write_bytes(damage(whole))
    again = fresh_kernel()
    assert again(2.0) == 6.0
    assert hits(again) == 0
    (sentence,) = said(caplog)
    assert str(kept) in sentence
    after = fresh_kernel()
    assert after(2.0) == 6.0
    assert hits(after) == 1


def test_a_folder_in_the_place_of_a_file_is_no_obstacle(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    fresh_kernel()(2.0)
    (kept,) = folder.iterdir()
    kept.unlink()
    kept.mkdir()
    assert fresh_kernel()(2.0) == 6.0
    assert said(caplog)


def test_a_cache_that_cannot_be_a_folder_is_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    obstacle = tmp_path / "file"
    obstacle.write_text("")
    monkeypatch.setenv(CACHE_VARIABLE, str(obstacle))
    disk_cache._warn_once.cache_clear()
    assert [fresh_kernel()(2.0), fresh_kernel()(2.0)] == [6.0, 6.0]
    assert len([sentence for sentence in said(caplog) if "cannot be kept" in sentence]) == 1
    assert obstacle.read_text() == ""


@pytest.mark.parametrize("reason", [errno.ENOSPC, errno.EROFS, errno.EACCES, errno.EDQUOT])
def test_a_disk_that_takes_nothing_is_done_without(
    reason: int, folder: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def refuse(*arguments: Any) -> None:
        raise OSError(reason, os.strerror(reason))

    monkeypatch.setattr(disk_cache.os, "replace", refuse)
    assert fresh_kernel()(2.0) == 6.0
    (sentence,) = said(caplog)
    assert os.strerror(reason) in sentence
    assert not any(folder.iterdir())


def test_a_cache_that_can_only_be_read_is_read(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fresh_kernel()(2.0)
    monkeypatch.setattr(disk_cache.tempfile, "mkstemp", lambda **_: pytest.fail("written to"))
    again = fresh_kernel()
    assert again(2.0) == 6.0
    assert hits(again) == 1


def test_programs_that_compile_at_once_do_not_harm_each_other(folder: Path, tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(_PROGRAM)
    root = Path(__file__).parents[2]
    command = [sys.executable, str(program)]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    started = [
        subprocess.Popen([*command, str(x)], env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for x in (1.0, 2.0, 4.0)
    ]
    answers = [process.communicate(timeout=120) for process in started]
    assert answers == [("3.0\n", ""), ("6.0\n", ""), ("12.0\n", "")]
    (kept,) = folder.iterdir()
    assert kept.suffix == ENDING


def test_other_source_is_another_file(folder: Path) -> None:
    """Else a function would be what it was before it was edited."""
    fresh_kernel()(2.0)

    @kernel
    def scaled(x: float) -> float:
        return 4.0 * x

    scaled.py_func.__qualname__ = fresh_kernel().py_func.__qualname__  # type: ignore[attr-defined]
    assert scaled(2.0) == 8.0
    assert len(list(folder.iterdir())) == 2
