"""Damaged files and unusable folders of compiled kernels change no result."""

from __future__ import annotations

import errno
import logging
import os
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from multiprocessing.synchronize import Barrier
from pathlib import Path
from typing import Any

import pytest
from numba.core.codegen import JITCPUCodegen

import engine.integrator
from engine.foundations import cache_files
from engine.foundations.cache_files import CACHE_VARIABLE, SUFFIX
from engine.integrator.jit import source_digests
from engine.integrator.jit.decorator import kernel
from tests.forked import Finished, fork_context, run


def fresh_kernel() -> Callable[[float], float]:
    """Return a new object of the same kernel, as a new process would have."""

    @kernel
    def scaled(x: float) -> float:
        return 3.0 * x

    compiled: Callable[[float], float] = scaled
    return compiled


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    return tmp_path / "cache" / "kernels"


def hits(compiled: Any) -> int:
    return sum(compiled.dispatcher.stats.cache_hits.values())


def warnings(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]


def test_a_kernel_is_compiled_once_and_then_loaded(folder: Path) -> None:
    assert fresh_kernel()(2.0) == 6.0
    (file,) = folder.iterdir()
    assert file.suffix == SUFFIX
    written = file.stat().st_mtime_ns
    again = fresh_kernel()
    assert again(2.0) == 6.0
    assert hits(again) == 1
    assert file.stat().st_mtime_ns == written


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: b"",
        lambda content: content[:-1],
        lambda content: content[:500] + bytes([content[500] ^ 1]) + content[501:],
        lambda content: content + b"more",
    ],
    ids=["empty", "one byte short", "one bit", "longer"],
)
def test_a_damaged_file_is_detected_and_replaced(
    damage: Callable[[bytes], bytes], folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    fresh_kernel()(2.0)
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    file.write_bytes(damage(whole))
    again = fresh_kernel()
    assert again(2.0) == 6.0
    assert hits(again) == 0
    (message,) = warnings(caplog)
    assert str(file) in message
    after = fresh_kernel()
    assert after(2.0) == 6.0
    assert hits(after) == 1


def test_code_for_another_processor_is_not_loaded(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fresh_kernel()(2.0)
    monkeypatch.setattr(JITCPUCodegen, "magic_tuple", lambda codegen: ("another", "processor"))
    again = fresh_kernel()
    assert again(2.0) == 6.0
    assert hits(again) == 0
    assert len(list(folder.iterdir())) == 2


def test_kernels_work_without_a_cache_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    obstacle = tmp_path / "file"
    obstacle.write_text("")
    monkeypatch.setenv(CACHE_VARIABLE, str(obstacle))
    assert [fresh_kernel()(2.0), fresh_kernel()(2.0)] == [6.0, 6.0]
    assert len([message for message in warnings(caplog) if "cannot be stored" in message]) == 1
    assert obstacle.read_text() == ""


def test_kernels_work_when_files_cannot_be_written(
    folder: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def refuse(*arguments: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(cache_files.os, "replace", refuse)
    assert fresh_kernel()(2.0) == 6.0
    (message,) = warnings(caplog)
    assert os.strerror(errno.ENOSPC) in message
    assert not any(folder.iterdir())


def test_a_cache_is_read_without_writing_to_it(folder: Path) -> None:
    fresh_kernel()(2.0)
    before = folder.stat().st_mtime_ns
    again = fresh_kernel()
    assert again(2.0) == 6.0
    assert hits(again) == 1
    assert folder.stat().st_mtime_ns == before


def compile_and_print(x: float, all_ready: Barrier) -> None:
    compiled = fresh_kernel()
    all_ready.wait()
    sys.stdout.write(f"{compiled(x)}\n")


def test_processes_that_compile_at_once_do_not_affect_each_other(folder: Path, tmp_path: Path) -> None:
    all_ready = fork_context().Barrier(3)
    outputs = [tmp_path / str(n) for n in range(3)]
    for output in outputs:
        output.mkdir()
    with ThreadPoolExecutor(3) as pool:
        found = pool.map(lambda output, x: run(output, compile_and_print, x, all_ready), outputs, (1.0, 2.0, 4.0))
        assert list(found) == [Finished(0, "3.0\n", ""), Finished(0, "6.0\n", ""), Finished(0, "12.0\n", "")]
    (file,) = folder.iterdir()
    assert file.suffix == SUFFIX


def test_an_edited_function_has_another_file(folder: Path) -> None:
    fresh_kernel()(2.0)

    @kernel
    def scaled(x: float) -> float:
        return 3.0 * x + 1.0

    scaled.py_func.__qualname__ = fresh_kernel().py_func.__qualname__  # type: ignore[attr-defined]
    assert scaled(2.0) == 7.0
    assert len(list(folder.iterdir())) == 2


OTHER_USER = 54321


@pytest.mark.parametrize(
    ("refuse", "reason"),
    [
        (lambda folder: folder.chmod(0o777), "other users may write to it"),
        pytest.param(
            lambda folder: os.chown(folder, OTHER_USER, -1),
            f"user {OTHER_USER} owns it",
            marks=pytest.mark.skipif(os.geteuid() != 0, reason="only root gives files to another user"),
        ),
    ],
)
def test_a_folder_of_other_users_is_neither_read_nor_written(
    refuse: Callable[[Path], None], reason: str, folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    fresh_kernel()(2.0)
    (file,) = folder.iterdir()
    before = file.stat().st_mtime_ns
    refuse(folder)
    again = fresh_kernel()
    assert again(2.0) == 6.0
    assert hits(again) == 0
    assert file.stat().st_mtime_ns == before
    (message,) = warnings(caplog)
    assert str(folder) in message
    assert reason in message


def test_a_file_that_others_may_write_is_replaced(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    fresh_kernel()(2.0)
    (file,) = folder.iterdir()
    file.chmod(0o620)
    again = fresh_kernel()
    assert again(2.0) == 6.0
    assert hits(again) == 0
    (message,) = warnings(caplog)
    assert str(file) in message
    assert "chmod go-w" in message
    assert file.stat().st_mode & 0o077 == 0


def test_a_new_folder_is_private_with_any_umask(folder: Path) -> None:
    before = os.umask(0)
    try:
        fresh_kernel()(2.0)
    finally:
        os.umask(before)
    assert folder.stat().st_mode & 0o077 == 0


def test_the_least_recently_used_files_are_deleted(folder: Path) -> None:
    kept, removed, new = (folder / f"{name}{SUFFIX}" for name in ("kept", "removed", "new"))
    for path in (kept, removed):
        cache_files.write_cached(path, bytes(1000))
    for n, path in enumerate((kept, removed)):
        os.utime(path, ns=(n, n))
    assert cache_files.read_cached(kept) == bytes(1000)
    # An incomplete file of a killed process also counts.
    killed = folder / "killed.part"
    killed.write_bytes(bytes(1000))
    os.utime(killed, ns=(0, 0))
    cache_files.write_cached(new, bytes(1000))
    cache_files.delete_least_recently_used(folder, largest_size=2500)
    assert {*folder.iterdir()} == {kept, new}


def test_the_number_of_files_is_limited(folder: Path) -> None:
    for n, name in enumerate("abc"):
        cache_files.write_cached(folder / f"{name}{SUFFIX}", b"")
        os.utime(folder / f"{name}{SUFFIX}", ns=(n, n))
    cache_files.delete_least_recently_used(folder, most_files=2)
    assert {path.stem for path in folder.iterdir()} == {"b", "c"}


def test_a_process_that_writes_many_files_meets_the_limit(folder: Path) -> None:
    cache_files.write_cached(folder / f"first{SUFFIX}", b"")
    for n in range(cache_files.MOST_FILES):
        (folder / f"old{n}{SUFFIX}").touch()
    for n in range(cache_files.WRITES_PER_DELETION):
        cache_files.write_cached(folder / f"new{n}{SUFFIX}", b"")
    assert len([*folder.iterdir()]) < cache_files.MOST_FILES + cache_files.WRITES_PER_DELETION


def test_a_change_anywhere_in_the_package_gives_another_file(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Compiled code contains copies of kernels and constants from other modules and subpackages."""
    assert Path(engine.integrator.__file__).parent == source_digests.PACKAGE
    for number, (text, expected) in enumerate([("A = 1", 1), ("A = 2", 2), ("A = 2", 2)]):
        module = tmp_path / str(number) / "source" / "deep" / "er.py"
        module.parent.mkdir(parents=True)
        module.write_text(text)
        monkeypatch.setattr(source_digests, "PACKAGE", tmp_path / str(number))
        fresh_kernel()(2.0)
        assert len(list(folder.iterdir())) == expected
