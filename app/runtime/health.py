"""Readiness of the server, and admission of new sessions."""

from __future__ import annotations

import psutil

from app.runtime.process_state import ProcessState
from app.runtime.settings import variable_name
from app.runtime.visitors import is_near
from engine.integrator.jit.compiled_operations import compiled_operations


def resident_bytes() -> int:
    """Return the resident memory of the process in bytes."""
    return int(psutil.Process().memory_info().rss)


def not_ready_reason(state: ProcessState) -> str | None:
    """Return a sentence that says why a load balancer should send no more visitors; None when the server is ready."""
    if state.stopping.is_set():
        return "The server is stopping."
    if state.kernels_failed.is_set():
        return "The integrators could not be compiled; the log says why."
    if not state.kernels_ready.is_set():
        return "The integrators are being compiled."
    ceiling, memory = state.settings.memory_ceiling, resident_bytes()
    if ceiling and memory > ceiling:
        return f"The server holds {memory} bytes, above {variable_name('memory_ceiling')}={ceiling}."
    if compiled_operations.is_nearly_full():
        limit = f"{variable_name('compiled_operations')}={state.settings.compiled_operations}"
        return f"Further typed potentials will soon be refused: {compiled_operations.used} of {limit}. Restart the server."
    return _full_reason(state)


def refusal_reason(state: ProcessState, network: str) -> str | None:
    """Return a sentence that says why no session can be created; None when one can.

    Weaker than readiness: sessions are created while the integrators are compiled, and wait on the page.

    Parameters
    ----------
    state
        The state of the process.
    network
        Whoever asks for the session, as in `ProcessState.sockets`.
    """
    if state.stopping.is_set():
        return "The server is stopping."
    return _full_reason(state, network)


def _full_reason(state: ProcessState, network: str = "") -> str | None:
    limit = state.settings.most_sessions
    if sum(1 for _ in state.sessions()) >= limit:
        return f"All {limit} places are taken."
    if not (_is_alone(state, network) or state.capacity.has_room(state.pages(), network)):
        return "The server is busy with the pages that are open."
    return None


def _is_alone(state: ProcessState, network: str) -> bool:
    """Whether a visitor disturbs nobody: on this machine, or with one page at most, which is perhaps being reloaded."""
    return (network != "" and is_near(network)) or state.sockets.total() <= min(state.sockets[network], 1)
