"""Readiness of the server, admission of new sessions, and gauges of its state for Prometheus."""

from __future__ import annotations

from collections.abc import Iterator

import psutil
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from app.runtime.capacity import FULL, WINDOW_SECONDS
from app.runtime.metrics import NAMESPACE
from app.runtime.process_state import ProcessState
from app.runtime.settings import variable_name
from app.runtime.visitors import is_local
from engine.integrator.jit.compiled_operations import compiled_operations


def resident_bytes() -> int:
    """Return the resident memory of the process in bytes."""
    return int(psutil.Process().memory_info().rss)


def not_ready_reason(state: ProcessState) -> str | None:
    """Return a sentence that says why the server is not ready for more visitors; None if the server is ready."""
    if state.stopping.is_set():
        return "The server is stopping."
    if state.kernels_failed.is_set():
        return "The integrators could not be compiled; the log says why."
    if not state.kernels_ready.is_set():
        return "The integrators are being compiled."
    ceiling = state.settings.memory_ceiling
    memory = resident_bytes()
    if ceiling and memory > ceiling:
        return f"The server holds {memory} bytes, above {variable_name('memory_ceiling')}={ceiling}."
    if compiled_operations.is_nearly_full():
        limit = f"{variable_name('compiled_operations')}={state.settings.compiled_operations}"
        return f"Further typed potentials will soon be refused: {compiled_operations.used} of {limit}. Restart the server."
    return _full_reason(state)


def refusal_reason(state: ProcessState, network: str) -> str | None:
    """Return a sentence that says why no session can be created; None if one can be created.

    Unlike readiness, this does not need the integrators: sessions are created during the compilation, and their pages wait.

    Parameters
    ----------
    state
        The state of the process.
    network
        The network of the visitor, see `app.runtime.visitors.network_of`.
    """
    return "The server is stopping." if state.stopping.is_set() else _full_reason(state, network)


def _full_reason(state: ProcessState, network: str = "") -> str | None:
    limit = state.settings.most_sessions
    if sum(1 for _ in state.sessions()) >= limit:
        return f"All {limit} places are taken."
    if not (_is_alone(state, network) or state.capacity.has_room(state.pages(), network)):
        return "The server is busy with the pages that are open."
    return None


def _is_alone(state: ProcessState, network: str) -> bool:
    """Whether a visitor is on this machine, or no page is open except perhaps one of this visitor, who may be reloading it."""
    if network and is_local(network):
        return True
    own_page_count = min(state.sockets[network], 1)
    return state.sockets.total() <= own_page_count


class StateCollector(Collector):
    """Reads gauges from the process state whenever Prometheus collects the metrics."""

    def __init__(self, state: ProcessState) -> None:
        self._state = state

    def describe(self) -> list[Metric]:
        """Return nothing, so that the registry does not collect values at registration."""
        return []

    def collect(self) -> Iterator[Metric]:
        """Return the gauges."""
        state = self._state
        sessions = list(state.sessions())
        yield _gauge("ready", "Whether the server is ready", not_ready_reason(state) is None)
        yield _gauge("kernels_ready", "Whether the integrators are compiled", state.kernels_ready.is_set())
        yield _gauge("sessions_open", "Open sessions", len(sessions))
        yield _gauge("sessions_limit", "Maximum number of sessions", state.settings.most_sessions)
        yield _gauge("websockets_open", "Open WebSockets", sum(session.connection_count for session in sessions))
        yield _gauge("crowded", "Whether work that can wait is put off", state.is_crowded())
        yield _gauge("cores", f"Processors that other programs left in the last {WINDOW_SECONDS} s", state.capacity.cores)
        yield _gauge("cores_per_page", "Processors that an active visitor is assumed to use", state.capacity.cores_per_page)
        yield _gauge(
            "capacity_taken",
            f"Share of these, or of the event loop, that open pages may take; beyond {FULL:g} pages are refused",
            state.capacity.occupied_share(state.pages()),
        )
        yield _gauge("resident_memory_bytes", "Resident memory", resident_bytes())
        yield from _limited_metrics(state)
        yield from _job_metrics(state)


def _limited_metrics(state: ProcessState) -> Iterator[Metric]:
    """Return the metrics of the processes with limits."""
    totals = {"review": state.limited.totals, "compilation": state.compiler.totals}
    calls = CounterMetricFamily(f"{NAMESPACE}_limited_calls", "Calls of the processes with limits", labels=["task", "how"])
    seconds = CounterMetricFamily(f"{NAMESPACE}_limited_seconds", "Processor time of these calls", labels=["task"])
    memory = GaugeMetricFamily(f"{NAMESPACE}_limited_memory_bytes", "Resident memory of these processes", labels=["task"])
    for task, total in totals.items():
        calls.add_metric([task, "answered"], total.answered)
        calls.add_metric([task, "stopped"], total.stopped)
        seconds.add_metric([task], total.seconds)
        memory.add_metric([task], total.resident_bytes)
    yield from (calls, seconds, memory)


def _job_metrics(state: ProcessState) -> Iterator[Metric]:
    stats = state.jobs.stats()
    yield _gauge("jobs_in_flight", "Running and queued jobs", stats.in_flight)
    yield _gauge("calls_waiting", "Calls of these jobs that no thread has started", stats.calls_waiting)
    yield _gauge("reviews_waiting", "Reviews of typed formulas among these calls", stats.limited_calls_waiting)
    ended = CounterMetricFamily(f"{NAMESPACE}_jobs_ended", "Ended jobs by outcome", labels=["how"])
    for outcome in ("done", "failed", "cancelled"):
        ended.add_metric([outcome], getattr(stats, outcome))
    yield ended
    yield _gauge("cache_bytes", "Size of the result cache", stats.cache_bytes)
    yield _gauge("compiled_operations", "Compiled operations of integrators without the catalogue's", compiled_operations.used)
    yield _gauge("compiled_operations_limit", "Maximum number of compiled operations", state.settings.compiled_operations)
    yield _gauge("cache_limit_bytes", "Size limit of the result cache", stats.cache_limit)
    yield _gauge("orbits_held", "Orbits of large running jobs", stats.orbits_held)
    yield _gauge("orbits_limit", "Maximum number of orbits of large running jobs", stats.orbits_limit)
    yield _gauge("threads", "Compute threads", stats.threads)


def _gauge(name: str, documentation: str, value: float) -> Metric:
    return GaugeMetricFamily(f"{NAMESPACE}_{name}", documentation, value=float(value))
