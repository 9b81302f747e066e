"""A lock of output has one holder, is refused to other processes with the name of its holder, and ends with its process."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import signal
import sys
from multiprocessing.synchronize import Event
from pathlib import Path

import pytest

from engine.foundations.output_lock import hold_lock, replaced_file
from tests.forked import fork_context, start
from tests.waiting import SECONDS

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such locks")


@pytest.mark.skipif(not Path("/proc").exists(), reason="no folder without permission to write, even for the superuser")
def test_a_place_where_nothing_can_be_written_is_not_called_locked() -> None:
    with pytest.raises(OSError, match=r"'/proc/sweep\.zarr'") as raised, hold_lock(Path("/proc/sweep.zarr")):
        pass
    assert not isinstance(raised.value, BlockingIOError)


def hold(path: Path, held: Event, end: Event) -> None:
    with hold_lock(path):
        held.set()
        end.wait()


def test_the_second_process_learns_who_holds_the_lock(tmp_path: Path) -> None:
    held, end = fork_context().Event(), fork_context().Event()
    process = start(hold, tmp_path / "out", held, end)
    assert held.wait(SECONDS)
    with (
        pytest.raises(BlockingIOError, match=rf"out: is being written by process {process.pid} on .* since"),
        hold_lock(tmp_path / "out"),
    ):
        pass
    end.set()
    process.join(SECONDS)
    with hold_lock(tmp_path / "out"):
        pass
    assert not any(tmp_path.iterdir())


def test_a_killed_process_holds_no_lock(tmp_path: Path) -> None:
    held, end = fork_context().Event(), fork_context().Event()
    process = start(hold, tmp_path / "out", held, end)
    assert held.wait(SECONDS)
    assert process.pid is not None
    os.kill(process.pid, signal.SIGKILL)
    process.join(SECONDS)
    assert any(tmp_path.iterdir())
    with hold_lock(tmp_path / "out"):
        pass
    assert not any(tmp_path.iterdir())


def test_a_link_to_the_same_place_has_the_same_lock(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "store")
    with hold_lock(tmp_path / "store"), pytest.raises(BlockingIOError), hold_lock(tmp_path / "link"):
        pass


def append_alone(path: Path, turns: int) -> None:
    """Hold the lock for a number of turns. In each turn, create a file that must not exist, and remove it."""
    marker = path.with_name("marker")
    while turns:
        with contextlib.suppress(BlockingIOError), hold_lock(path):
            marker.touch(exist_ok=False)
            marker.unlink()
            turns -= 1


def test_processes_that_take_turns_never_hold_the_lock_together(tmp_path: Path) -> None:
    """Each holder deletes the file of the lock, which waiting processes may have opened."""
    processes = [start(append_alone, tmp_path / "out", 50) for _ in range(3)]
    for process in processes:
        process.join(SECONDS)
    assert [process.exitcode for process in processes] == [0, 0, 0]
    assert not any(tmp_path.iterdir())


def test_a_file_system_without_locks_reserves_nothing_and_other_errors_of_the_disk_are_raised(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reasons = [errno.EIO, errno.ENOLCK, errno.ENOLCK]

    def refuse(*arguments: object) -> None:
        reason = reasons.pop()
        raise OSError(reason, os.strerror(reason))

    monkeypatch.setattr("fcntl.flock", refuse)
    with hold_lock(tmp_path / "out"), hold_lock(tmp_path / "out"):
        pass
    assert not any(tmp_path.iterdir())
    with pytest.raises(OSError, match=re.escape(os.strerror(errno.EIO))), hold_lock(tmp_path / "out"):
        pass


def write(path: Path, held: Event, end: Event) -> None:
    with replaced_file(path) as temporary:
        temporary.write_text("incomplete")
        held.set()
        end.wait()


def test_the_temporary_file_of_a_process_goes_with_the_next_writing_once_the_process_is_killed(tmp_path: Path) -> None:
    held, end = fork_context().Event(), fork_context().Event()
    process = start(write, tmp_path / "out", held, end)
    assert held.wait(SECONDS)
    assert process.pid is not None
    for is_killed in (False, True):
        if is_killed:
            os.kill(process.pid, signal.SIGKILL)
            process.join(SECONDS)
        with replaced_file(tmp_path / "out") as temporary:
            temporary.write_text("complete")
        assert (tmp_path / "out").read_text() == "complete"
        assert len(list(tmp_path.iterdir())) == (1 if is_killed else 2)
