"""Locks of output: one holder, named to all others, released by the end of its process."""

from __future__ import annotations

import os
import signal
import sys
from multiprocessing.synchronize import Event
from pathlib import Path

import pytest

from engine.file_lock import _lock
from engine.service import hold_lock
from tests.forked import fork_context, start

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such locks")


def hold(path: Path, held: Event, end: Event) -> None:
    with hold_lock(path):
        held.set()
        end.wait()


def test_the_second_process_learns_who_holds_the_lock(tmp_path: Path) -> None:
    held, end = fork_context().Event(), fork_context().Event()
    process = start(hold, tmp_path / "out", held, end)
    assert held.wait(60)
    with (
        pytest.raises(BlockingIOError, match=rf"out: is being written by process {process.pid} on .* since"),
        hold_lock(tmp_path / "out"),
    ):
        pass
    end.set()
    process.join(60)
    with hold_lock(tmp_path / "out"):
        pass
    assert not any(tmp_path.iterdir())


def test_a_killed_process_holds_no_lock(tmp_path: Path) -> None:
    held, end = fork_context().Event(), fork_context().Event()
    process = start(hold, tmp_path / "out", held, end)
    assert held.wait(60)
    assert process.pid is not None
    os.kill(process.pid, signal.SIGKILL)
    process.join(60)
    assert any(tmp_path.iterdir())
    with hold_lock(tmp_path / "out"):
        pass
    assert not any(tmp_path.iterdir())


def test_a_link_to_the_same_place_has_the_same_lock(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "store")
    with hold_lock(tmp_path / "store"), pytest.raises(BlockingIOError), hold_lock(tmp_path / "link"):
        pass


def test_different_outputs_of_a_folder_have_different_locks(tmp_path: Path) -> None:
    with hold_lock(tmp_path / "one"), hold_lock(tmp_path / "two"):
        assert len(list(tmp_path.iterdir())) == 2


def test_a_lock_file_deleted_by_its_last_holder_is_created_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / ".out.lock"
    tries = []

    def lock(descriptor: int, path: Path) -> None:
        _lock(descriptor, path)
        tries.append(descriptor)
        if len(tries) == 1:
            file.unlink()

    monkeypatch.setattr("engine.file_lock._lock", lock)
    with hold_lock(tmp_path / "out"):
        assert file.exists()
    assert len(tries) == 2
