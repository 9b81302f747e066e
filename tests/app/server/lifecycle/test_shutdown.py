"""The process ends within seconds of a signal, whatever its event loop does."""

from __future__ import annotations

import asyncio
import hashlib
import os
import signal
import time
from collections.abc import Callable
from multiprocessing.synchronize import Event

import pytest

from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings
from app.server.lifecycle.shutdown import finish_shutdown, stop_on_signals
from tests import forked
from tests.waiting import SECONDS

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")

# A process that gets a processor ends after 5 s at the latest. Without the end, an occupied event loop would last for minutes.
LIMIT_SECONDS = 30.0


def compute_in_python() -> None:
    while True:
        sum(range(1000))


def call_into_c() -> None:
    """Stay for minutes in one call of C, which releases the interpreter lock."""
    hashlib.pbkdf2_hmac("sha512", b"password", b"salt", 2**30)


def do_nothing() -> None:
    """Leave the event loop idle."""


def serve(started: Event, stopped: Event, occupy: Callable[[], None]) -> None:
    """Do what `panel serve` does, without a server, and occupy the event loop as soon as it runs."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    asyncio.run(_serve(started, stopped, occupy))


async def _serve(started: Event, stopped: Event, occupy: Callable[[], None]) -> None:
    state, loop_stopped = ProcessState(Settings(threads=1)), asyncio.Event()
    stop_on_signals(state, loop_stopped.set)
    started.set()
    occupy()
    await loop_stopped.wait()
    stopped.set()
    finish_shutdown(state)


@pytest.mark.slow
@pytest.mark.parametrize("occupy", [compute_in_python, call_into_c])
def test_process_with_an_occupied_event_loop_ends_in_time(occupy: Callable[[], None]) -> None:
    assert not end_by_signal(signal.SIGTERM, occupy)


def test_event_loop_stops_after_a_signal() -> None:
    assert end_by_signal(signal.SIGTERM, do_nothing)


def end_by_signal(number: signal.Signals, occupy: Callable[[], None]) -> bool:
    """End a process by a signal, check its exit code and duration, and return whether its event loop stopped before the end."""
    started, stopped = forked.fork_context().Event(), forked.fork_context().Event()
    process = forked.start(serve, started, stopped, occupy)
    assert started.wait(SECONDS)
    begin = time.monotonic()
    os.kill(process.pid or 0, number)
    process.join(SECONDS)
    assert time.monotonic() - begin < LIMIT_SECONDS
    assert process.exitcode == 0
    return stopped.is_set()


def test_an_ignored_signal_stays_ignored() -> None:
    process = forked.start(check_ignored)
    process.join(SECONDS)
    assert process.exitcode == 0


def check_ignored() -> None:
    async def install() -> None:
        stop_on_signals(ProcessState(Settings(threads=1)), lambda: None)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    asyncio.run(install())
    # The threads of the state would delay a regular exit.
    os._exit(signal.getsignal(signal.SIGINT) is not signal.SIG_IGN)
