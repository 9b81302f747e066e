"""Readiness and admission."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.runtime.health import not_ready_reason, refusal_reason, resident_bytes
from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings
from engine.taylor.jit.compiled_operations import LARGEST_CODE, CompiledOperations

HERE, ELSEWHERE = "192.0.2.1", "192.0.2.2"


@pytest.fixture
def state() -> ProcessState:
    ready = ProcessState(Settings(most_sessions=2))
    ready.kernels_ready.set()
    return ready


def test_ready(state: ProcessState) -> None:
    assert not_ready_reason(state) is None
    assert refusal_reason(state, HERE) is None


def test_not_ready_but_open_during_compilation(state: ProcessState) -> None:
    state.kernels_ready.clear()
    assert not_ready_reason(state) == "The integrators are being compiled."
    assert refusal_reason(state, HERE) is None


def test_not_ready_after_failed_compilation(state: ProcessState) -> None:
    state.kernels_ready.clear()
    state.kernels_failed.set()
    assert "could not be compiled" in str(not_ready_reason(state))


def test_full_server_refuses_sessions(state: ProcessState) -> None:
    state.sessions = lambda: [object()] * 2
    assert not_ready_reason(state) == refusal_reason(state, HERE) == "All 2 places are taken."


def test_overloaded_server_refuses_sessions(state: ProcessState) -> None:
    state.overload.add(1000.0)
    state.sockets[ELSEWHERE] += 1
    assert not_ready_reason(state) == refusal_reason(state, HERE)
    assert str(refusal_reason(state, HERE)).startswith("The server is busy")


def test_overloaded_server_admits_its_only_visitor(state: ProcessState) -> None:
    state.overload.add(1000.0)
    assert refusal_reason(state, HERE) is None
    # The connection of the page before a reload, for example.
    state.sockets[HERE] += 1
    assert refusal_reason(state, HERE) is None
    assert str(not_ready_reason(state)).startswith("The server is busy")


def test_stopping_server_refuses_sessions(state: ProcessState) -> None:
    state.stopping.set()
    assert str(not_ready_reason(state)).startswith("The server is stopping.")
    assert str(refusal_reason(state, HERE)).startswith("The server is stopping.")


def test_not_ready_above_memory_ceiling(state: ProcessState, monkeypatch: pytest.MonkeyPatch) -> None:
    state.settings = replace(state.settings, memory_ceiling=1000)
    monkeypatch.setattr("app.runtime.health.resident_bytes", lambda: 1001)
    assert not_ready_reason(state) == "The server holds 1001 bytes, above ESCAPE_EXPLORER_MEMORY_CEILING=1000."


def test_not_ready_when_little_room_for_compiled_code_is_left(state: ProcessState, monkeypatch: pytest.MonkeyPatch) -> None:
    operations = CompiledOperations()
    operations.most = state.settings.compiled_operations
    monkeypatch.setattr("app.runtime.health.compiled_operations", operations)
    assert not_ready_reason(state) is None
    for number in range(5):
        operations.add(f"potential {number}", LARGEST_CODE)
    assert str(not_ready_reason(state)).endswith("ESCAPE_EXPLORER_COMPILED_OPERATIONS=250000. Restart the server.")
    # The catalogue is served as before.
    assert refusal_reason(state, HERE) is None


def test_resident_memory_is_plausible() -> None:
    assert 2**20 < resident_bytes() < 2**40
