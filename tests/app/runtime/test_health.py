"""A server says why it is not ready, and whom it refuses."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from app.runtime.health import not_ready_reason, refusal_reason, resident_bytes
from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings
from engine.integrator.jit.compiled_operations import LARGEST_CODE, compiled_operations

HERE, ELSEWHERE = "192.0.2.1", "192.0.2.2"


def fill(state: ProcessState) -> None:
    state.sessions = lambda: [object()] * 2


def crowd(state: ProcessState) -> None:
    state.capacity.cores = 0.01
    state.sockets[ELSEWHERE] += 1


def crowd_alone(state: ProcessState) -> None:
    state.capacity.cores = 0.01
    # A single connection, such as that of a page before its reload.
    state.sockets[HERE] += 1


def crowd_with_several_pages(state: ProcessState) -> None:
    state.capacity.cores = 0.01
    state.sockets[HERE] += 2


def fail_to_compile(state: ProcessState) -> None:
    state.kernels_ready.clear()
    state.kernels_failed.set()


def compile_potentials(state: ProcessState) -> None:
    for number in range(10):
        compiled_operations.add(f"potential {number}", LARGEST_CODE)


@pytest.mark.parametrize(
    ("change", "not_ready", "refusal"),
    [
        (lambda state: None, "", ""),
        (lambda state: state.kernels_ready.clear(), "The integrators are being compiled.", ""),
        (fail_to_compile, "could not be compiled", ""),
        (fill, "All 2 places are taken.", "All 2 places are taken."),
        (crowd, "The server is busy", "The server is busy"),
        (crowd_alone, "The server is busy", ""),
        (crowd_with_several_pages, "The server is busy", "The server is busy"),
        (lambda state: state.stopping.set(), "The server is stopping.", "The server is stopping."),
        # Nobody is refused, because the catalogue is served as before.
        (compile_potentials, "ESCAPE_EXPLORER_COMPILED_OPERATIONS=500000. Restart the server.", ""),
    ],
    ids=["ready", "compiling", "failed", "full", "busy", "busy with this page", "busy with this visitor", "stopping", "code"],
)
def test_a_server_says_why_it_is_not_ready_and_whom_it_refuses(
    change: Callable[[ProcessState], None], not_ready: str, refusal: str
) -> None:
    state = ProcessState(Settings(most_sessions=2))
    state.kernels_ready.set()
    change(state)
    for expected, reason in ((not_ready, not_ready_reason(state)), (refusal, refusal_reason(state, HERE))):
        assert (reason is None) == (not expected)
        assert expected in (reason or "")


def test_nobody_is_refused_on_this_machine() -> None:
    state = ProcessState(Settings())
    crowd_with_several_pages(state)
    assert refusal_reason(state, "127.0.0.1") is None
    assert refusal_reason(state, "::1") is None


def test_a_server_above_its_memory_ceiling_is_not_ready() -> None:
    state = ProcessState(Settings(memory_ceiling=1000))
    state.kernels_ready.set()
    assert 2**20 < resident_bytes() < 2**40
    assert str(not_ready_reason(state)).endswith(" bytes, above ESCAPE_EXPLORER_MEMORY_CEILING=1000.")
