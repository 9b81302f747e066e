"""Calls that exceed their time or memory end, without effects on later calls."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np
import psutil
import pytest

from app.runtime.limited_process import CallTotals, LimitedProcess, LimitedProcesses, LimitError
from engine import System, parse_formula
from engine.systems.formulas.formula_tokens import FormulaError
from engine.systems.review.potential_review import review_system
from tests import forked
from tests.waiting import SECONDS


@pytest.fixture(scope="module")
def limited() -> Iterator[LimitedProcess]:
    process = LimitedProcess(seconds=1, memory=2**29)
    yield process
    process.close()


def compute_forever() -> None:
    while True:
        pass


def fill_memory() -> None:
    parts = []
    while True:
        parts.append(np.ones(2**22))


def read_pipe(pipe: Path) -> str:
    """Return the text that another process writes, when it is written."""
    return pipe.read_text()


def recurse() -> None:
    recurse()


@pytest.mark.parametrize("function", [compute_forever, fill_memory, recurse])
def test_a_call_beyond_a_limit_is_refused_and_the_next_one_is_answered(limited: LimitedProcess, function: object) -> None:
    before = limited.totals.stopped
    with pytest.raises(LimitError, match=r"^reviewing this formula needs more than 1 s or 512 MB; "):
        limited(function)  # type: ignore[arg-type]
    assert limited.totals.stopped == before + 1
    assert limited(partial(divmod, 7, 2)) == (3, 1)


def test_a_call_that_gets_no_processor_is_refused_and_the_next_one_is_answered() -> None:
    process = LimitedProcess(seconds=1, longest_wait=20.0)
    assert process(partial(divmod, 7, 2)) == (3, 1)
    with pytest.raises(LimitError, match=r"^reviewing this formula takes too long while the machine is busy; "):
        process(signal.pause)
    assert process(partial(divmod, 7, 2)) == (3, 1)
    process.close()


def test_a_process_that_was_started_answers_the_next_call() -> None:
    process, children = LimitedProcess(), {child.pid for child in psutil.Process().children()}
    process.start()
    started = {child.pid for child in psutil.Process().children()} - children
    assert process(os.getpid) in started
    process.close()


def test_a_call_that_nobody_waits_for_ends_before_its_limit() -> None:
    process, abandoned = LimitedProcess(seconds=1000), threading.Event()
    abandoned.set()
    with pytest.raises(CancelledError):
        process(compute_forever, abandoned)
    assert process.totals.stopped == 0
    assert process(partial(divmod, 7, 2)) == (3, 1)
    process.close()


def test_calls_share_a_process_which_is_replaced_when_it_ends(limited: LimitedProcess) -> None:
    first = limited(os.getpid)
    assert limited(os.getpid) == first != os.getpid()
    with pytest.raises(LimitError):
        limited(partial(os._exit, 1))
    assert limited(os.getpid) != first


def test_a_call_that_ends_its_process_is_followed_by_another_process_before_the_next_call(limited: LimitedProcess) -> None:
    before = {child.pid for child in psutil.Process().children()} | {limited(os.getpid)}
    with pytest.raises(LimitError):
        limited(partial(os._exit, 1))
    [begun] = {child.pid for child in psutil.Process().children()} - before
    assert limited(os.getpid) == begun


def compute_for(seconds: float) -> None:
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def test_calls_their_time_and_the_memory_of_all_processes_are_counted() -> None:
    processes, smallest_process = LimitedProcesses(2), 2**24
    assert processes.totals == CallTotals()
    processes(partial(compute_for, 0.1))
    processes(partial(compute_for, 0.2))
    totals = processes.totals
    assert (totals.answered, totals.stopped) == (2, 0)
    assert 0.3 <= totals.seconds < 3.0
    assert totals.resident_bytes > smallest_process
    processes.close()
    assert processes.totals.resident_bytes == 0


def test_a_process_that_cannot_begin_is_reported_as_such() -> None:
    process = LimitedProcess(task="compiling this", longest_wait=0.0)
    with pytest.raises(LimitError, match=r"^compiling this could not begin: "):
        process(os.getpid)
    process.close()


def test_a_call_does_not_wait_for_a_call_in_another_process(tmp_path: Path) -> None:
    processes, pipe = LimitedProcesses(2), tmp_path / "pipe"
    os.mkfifo(pipe)
    with ThreadPoolExecutor(1) as thread:
        waiting = thread.submit(processes, partial(read_pipe, pipe))
        assert processes(partial(divmod, 7, 2)) == (3, 1)
        assert not waiting.done()
        pipe.write_text("released")
        assert waiting.result() == "released"
    processes.close()


def test_errors_of_the_function_are_raised(limited: LimitedProcess) -> None:
    before = limited.totals.stopped
    with pytest.raises(FormulaError, match="character 4: ") as caught:
        limited(partial(parse_formula, "x +"))
    assert (caught.value.position, limited.totals.stopped) == (3, before)


def test_the_review_of_a_formula_is_the_same_in_this_process(limited: LimitedProcess) -> None:
    system = System("typed", "½r² − a x²y exp(−y²)", {"a": 2.0})
    found, expected = limited(partial(review_system, system)), review_system(system)
    assert found == expected
    assert hash(found.potential) == hash(expected.potential)
    np.testing.assert_array_equal(found.potential.saddles, expected.potential.saddles)


def test_a_limit_of_the_system_stays(limited: LimitedProcess) -> None:
    resource = pytest.importorskip("resource")
    soft, hard = resource.getrlimit(resource.RLIMIT_CORE)
    found = limited(partial(resource.getrlimit, resource.RLIMIT_AS))
    assert 2**29 < found[0] < 2**33
    assert (resource.getrlimit(resource.RLIMIT_CORE), found[1]) == ((soft, hard), resource.getrlimit(resource.RLIMIT_AS)[1])


def serve_until_killed(found: Connection) -> None:
    process = LimitedProcess()
    found.send(process(os.getpid))
    threading.Event().wait()


def test_the_process_ends_after_its_server_is_killed() -> None:
    receiver, sender = forked.fork_context().Pipe(duplex=False)
    server = forked.start(serve_until_killed, sender)
    left = psutil.Process(receiver.recv())
    server.kill()
    server.join()
    psutil.wait_procs([left], timeout=SECONDS)
    assert not left.is_running()
