"""Counters and histograms of the server for Prometheus."""

from __future__ import annotations

import logging

from prometheus_client import CollectorRegistry, Counter, Histogram

NAMESPACE = "escape_explorer"

# Upper bounds of the time to a first frame, in seconds: from an immediate answer to the wait for a compilation.
_FIRST_FRAME_BUCKETS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0)

# Upper bounds of the delay of the event loop, in seconds.
_DELAY_BUCKETS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


class ServerMetrics:
    """Counters and histograms of a process, in a registry of their own."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        self.sessions_created = self._counter("sessions_created", "Sessions created")
        self.sessions_destroyed = self._counter("sessions_destroyed", "Sessions destroyed")
        self.pages_refused = self._counter("pages_refused", "Page requests refused because the server was full or stopping")
        self.connections_refused = self._counter("connections_refused", "Connections refused because there were too many")
        self.messages_delayed = self._counter("messages_delayed", "Messages delayed because their page took more than its share")
        self.log_records = self._counter("log_records", "Warnings and errors in the log", "level", "exception")
        self.loop_delays = Histogram(
            "event_loop_delay_seconds",
            "Seconds by which the event loop was late, by cause",
            ["cause"],
            namespace=NAMESPACE,
            registry=self.registry,
            buckets=_DELAY_BUCKETS,
        )
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
