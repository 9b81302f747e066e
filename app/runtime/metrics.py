"""Prometheus metrics of the server."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from typing import TYPE_CHECKING

from prometheus_client import CollectorRegistry, Counter, Histogram
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from app.runtime.health import not_ready_reason, resident_bytes

if TYPE_CHECKING:
    from app.runtime.process_state import ProcessState

NAMESPACE = "escape_explorer"

# Seconds; from an immediate answer to waiting for a compilation.
_FIRST_FRAME_BUCKETS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0)


class ServerMetrics:
    """Counters and gauges of a process, in a registry of their own."""

    def __init__(self, state: ProcessState) -> None:
        self.registry = CollectorRegistry()
        self.registry.register(_StateCollector(state))
        self.sessions_created = self._counter("sessions_created", "Sessions created")
        self.sessions_destroyed = self._counter("sessions_destroyed", "Sessions destroyed")
        self.pages_refused = self._counter("pages_refused", "Page requests refused because the server was full or stopping")
        self.log_records = self._counter("log_records", "Warnings and errors in the log", "level", "exception")
        self.first_frame = Histogram(
            "first_frame_seconds",
            "Seconds from the request for a map to its first frame",
            namespace=NAMESPACE,
            registry=self.registry,
            buckets=_FIRST_FRAME_BUCKETS,
        )

    def _counter(self, name: str, documentation: str, *labels: str) -> Counter:
        return Counter(name, documentation, labels, namespace=NAMESPACE, registry=self.registry)


class LogRecordCounter(logging.Handler):
    """Counts log records of level WARNING and above, by level and exception class."""

    def __init__(self, metrics: ServerMetrics) -> None:
        super().__init__(logging.WARNING)
        self._counter = metrics.log_records

    def emit(self, record: logging.LogRecord) -> None:
        """Count one record."""
        exception = record.exc_info[0] if record.exc_info else None
        self._counter.labels(record.levelname.lower(), exception.__qualname__ if exception else "").inc()


class _StateCollector(Collector):
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
        yield _gauge("resident_memory_bytes", "Resident memory", resident_bytes())
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
    yield _gauge("cache_limit_bytes", "Size limit of the result cache", stats.cache_limit)
    yield _gauge("orbits_held", "Orbits of large running jobs", stats.orbits_held)
    yield _gauge("orbits_limit", "Maximum number of orbits of large running jobs", stats.orbits_limit)
    yield _gauge("threads", "Compute threads", stats.threads)


def _gauge(name: str, documentation: str, value: float) -> Metric:
    return GaugeMetricFamily(f"{NAMESPACE}_{name}", documentation, value=float(value))
