"""Options of glibc limit the arenas of threads."""

from __future__ import annotations

import ctypes
import os
import platform
import threading
from multiprocessing.connection import Connection
from pathlib import Path

import pytest

from app.runtime.memory_allocation import reduce_fragmentation, return_free_memory
from tests import forked
from tests.waiting import SECONDS

THREADS = 12

pytestmark = pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="options of glibc")


def count_arenas(results: Connection, folder: Path, variables: dict[str, str]) -> None:
    """Send the number of arenas of a process in which many threads allocate memory at the same time."""
    os.environ.update(variables)
    reduce_fragmentation()
    library = ctypes.CDLL(None)
    barrier = threading.Barrier(THREADS + 1)

    def allocate() -> None:
        library.malloc(1000)
        barrier.wait()
        barrier.wait()

    threads = [threading.Thread(target=allocate, daemon=True) for _ in range(THREADS)]
    for thread in threads:
        thread.start()
    barrier.wait()
    library.fopen.restype = ctypes.c_void_p
    file = ctypes.c_void_p(library.fopen(str(folder / "arenas").encode(), b"w"))
    library.malloc_info(0, file)
    library.fclose(file)
    results.send((folder / "arenas").read_text().count("<heap nr="))
    barrier.wait()


def arenas(folder: Path, variables: dict[str, str]) -> int:
    receiver, sender = forked.fork_context().Pipe(duplex=False)
    process = forked.start(count_arenas, sender, folder, variables)
    assert receiver.poll(SECONDS)
    count: int = receiver.recv()
    process.join(SECONDS)
    return count


def test_threads_share_arenas(tmp_path: Path) -> None:
    assert arenas(tmp_path, {}) <= 3


def test_environment_variables_have_precedence(tmp_path: Path) -> None:
    assert arenas(tmp_path, {"MALLOC_ARENA_MAX": "16"}) > 3


def count_kilobytes(results: Connection) -> None:
    """Send the resident memory before and after the return of free memory that lies between allocations."""
    library = ctypes.CDLL(None)
    library.malloc.restype = ctypes.c_void_p
    pieces = [library.malloc(60_000) for _ in range(1000)]
    for piece in pieces:
        ctypes.memset(piece, 1, 60_000)
    for piece in pieces[::2]:
        library.free(ctypes.c_void_p(piece))
    before = resident_kilobytes()
    return_free_memory()
    results.send((before, resident_kilobytes()))


def resident_kilobytes() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4


def test_free_memory_between_allocations_is_returned() -> None:
    receiver, sender = forked.fork_context().Pipe(duplex=False)
    process = forked.start(count_kilobytes, sender)
    assert receiver.poll(SECONDS)
    before, after = receiver.recv()
    process.join(SECONDS)
    assert before - after > 20_000
