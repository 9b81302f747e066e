"""Gauges of the process state for Prometheus."""

from __future__ import annotations

from collections.abc import Iterator

from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from app.runtime.capacity import FULL, WINDOW_SECONDS
from app.runtime.health import not_ready_reason, resident_bytes
from app.runtime.metrics import NAMESPACE
from app.runtime.process_state import ProcessState
from engine.integrator.jit.compiled_operations import compiled_operations


class StateCollector(Collector):
    """Gauges that are read when the metrics are collected."""

    def __init__(self, state: ProcessState) -> None:
        self._state = state

    def describe(self) -> list[Metric]:
        """Return nothing, so that registration does not collect."""
        return []

    def collect(self) -> Iterator[Metric]:
        """Read the process state."""
        state = self._state
        sessions = list(state.sessions())
        yield _gauge("ready", "Whether the server is ready", not_ready_reason(state) is None)
        yield _gauge("kernels_ready", "Whether the integrators are compiled", state.kernels_ready.is_set())
        yield _gauge("sessions_open", "Open sessions", len(sessions))
        yield _gauge("sessions_limit", "Maximum number of sessions", state.settings.most_sessions)
        yield _gauge("websockets_open", "Open WebSockets", sum(session.connection_count for session in sessions))
        yield _gauge("crowded", "Whether work that can wait is put off", state.is_crowded())
        yield _gauge("cores", f"Processors that other programs left in the last {WINDOW_SECONDS} s", state.capacity.cores)
        yield _gauge(
            "capacity_taken",
            f"Share of these, or of the event loop, that open pages may take; beyond {FULL:g} pages are refused",
            state.capacity.taken(state.pages()),
        )
        yield _gauge("resident_memory_bytes", "Resident memory", resident_bytes())
        yield CounterMetricFamily(
            f"{NAMESPACE}_formulas_stopped",
            "Typed formulas whose review exceeded its time or its memory",
            value=state.limited.stopped,
        )
        yield from _job_metrics(state)


def _job_metrics(state: ProcessState) -> Iterator[Metric]:
    stats = state.jobs.stats()
    yield _gauge("jobs_in_flight", "Running and queued jobs", stats.in_flight)
    yield _gauge("calls_waiting", "Calls of these jobs that no thread has started", stats.calls_waiting)
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
