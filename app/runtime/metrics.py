"""What the server counts and measures, for Prometheus."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from functools import cache

from prometheus_client import CollectorRegistry, Counter, Histogram
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from app.runtime.health import why_not_ready
from app.runtime.memory import resident_bytes
from app.runtime.process_state import ProcessState, process_state

NAMESPACE = "escape_explorer"

# From what feels immediate to the wait for a compiler, in seconds.
_FIRST_FRAME_BUCKETS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0)


class Figures:
    """The counts of a site, with a registry of their own."""

    def __init__(self, site: ProcessState) -> None:
        self.registry = CollectorRegistry()
        self.registry.register(_Readings(site))
        self.created = self._counter("sessions_created", "Sessions that began")
        self.destroyed = self._counter("sessions_destroyed", "Sessions that ended")
        self.refused = self._counter("pages_refused", "Visitors sent away, as the server was full or stopping")
        self.faults = self._counter("log_records", "Warnings and errors in the log", "level", "exception")
        self.first_frame = Histogram(
            "first_frame_seconds",
            "Seconds from the request for a map to its first picture",
            namespace=NAMESPACE,
            registry=self.registry,
            buckets=_FIRST_FRAME_BUCKETS,
        )

    def _counter(self, name: str, words: str, *labels: str) -> Counter:
        return Counter(name, words, labels, namespace=NAMESPACE, registry=self.registry)


class FaultCounter(logging.Handler):
    """Counts what is logged from warnings upwards, by level and kind of exception."""

    def __init__(self, figures: Figures) -> None:
        super().__init__(logging.WARNING)
        self._faults = figures.faults

    def emit(self, record: logging.LogRecord) -> None:
        """Count one record."""
        kind = record.exc_info[0] if record.exc_info else None
        self._faults.labels(record.levelname.lower(), kind.__qualname__ if kind else "").inc()


class _Readings(Collector):
    """What is read when somebody asks."""

    def __init__(self, site: ProcessState) -> None:
        self._site = site

    def describe(self) -> list[Metric]:
        """Nothing ahead of time: names are known when they are read."""
        return []

    def collect(self) -> Iterator[Metric]:
        """The readings, now."""
        site = self._site
        yield _gauge("ready", "Whether more visitors are welcome", why_not_ready(site) is None)
        yield _gauge("kernels_ready", "Whether the integrators are compiled", site.prepared.is_set())
        sessions = list(site.sessions())
        yield _gauge("sessions_open", "Sessions that are open", len(sessions))
        yield _gauge("sessions_limit", "Most sessions", site.settings.most_sessions)
        yield _gauge("websockets_open", "Pages that are connected", sum(one.connection_count for one in sessions))
        memory = resident_bytes()
        if memory is not None:
            yield _gauge("resident_memory_bytes", "Memory that the process holds", memory)
        yield from _read_jobs(site)


def _read_jobs(site: ProcessState) -> Iterator[Metric]:
    if site.jobs is None:
        return
    now = site.jobs.figures()
    yield _gauge("jobs_in_flight", "Jobs that somebody waits for", now.in_flight)
    yield _gauge("calls_waiting", "Parts of jobs that no thread has taken up yet", now.calls_waiting)
    ended = CounterMetricFamily(f"{NAMESPACE}_jobs_ended", "Jobs that have ended, by how", labels=["how"])
    for how, count in {"done": now.done, "failed": now.failed, "cancelled": now.cancelled}.items():
        ended.add_metric([how], count)
    yield ended
    yield _gauge("cache_bytes", "Memory of kept results", now.cache_bytes)
    yield _gauge("cache_limit_bytes", "Most memory of kept results", now.cache_limit)
    yield _gauge("orbits_held", "Orbits of large jobs under way", now.orbits_held)
    yield _gauge("orbits_limit", "Most orbits of large jobs under way", now.orbits_limit)
    yield _gauge("threads", "Threads that compute", now.threads)


def _gauge(name: str, words: str, value: float) -> Metric:
    return GaugeMetricFamily(f"{NAMESPACE}_{name}", words, value=float(value))


@cache
def process_metrics() -> Figures:
    """Those of this process."""
    return Figures(process_state())


def observe_first_frame(seconds: float) -> None:
    """Count how long a visitor waited for the first picture of a map, in seconds."""
    process_metrics().first_frame.observe(seconds)
