"""Endpoints for the operator: two probes, Prometheus metrics and a status page."""

from __future__ import annotations

import http.client
from html import escape
from typing import Any

from prometheus_client import CollectorRegistry
from prometheus_client.exposition import CONTENT_TYPE_LATEST, generate_latest
from tornado.web import HTTPError

from app.runtime.health import not_ready_reason
from app.runtime.process_state import process_state
from app.server.security_headers import SecurityHeaders


class _UncachedHandler(SecurityHeaders):
    """Handler whose responses must not be cached."""

    def set_default_headers(self) -> None:
        """Forbid caching."""
        super().set_default_headers()
        self.set_header("Cache-Control", "no-store")


class Liveness(_UncachedHandler):
    """Answers 200 while the process responds, like ``panel serve --liveness``."""

    def get(self) -> None:
        """Answer with JSON."""
        self.write({self.request.path: True})


class Readiness(_UncachedHandler):
    """Answers 200 if the server accepts more visitors, otherwise 503 with the reason."""

    def get(self) -> None:
        """Answer with JSON."""
        reason = not_ready_reason(process_state())
        if reason is not None:
            self.set_status(http.client.SERVICE_UNAVAILABLE)
        self.write({"ready": reason is None, "sentence": reason or "Ready."})


class Metrics(_UncachedHandler):
    """Answers with metrics for Prometheus."""

    def get(self) -> None:
        """Answer with the Prometheus text format."""
        self.set_header("Content-Type", CONTENT_TYPE_LATEST)
        self.write(generate_latest(process_state().metrics.registry))


class Status(_UncachedHandler):
    """Answers with the same metrics as an HTML page for people."""

    def get(self) -> None:
        """Answer with HTML."""
        state = process_state()
        self.write(status_page(not_ready_reason(state) or "Ready.", state.metrics.registry))


class NotFound(SecurityHeaders):
    """Answers 404 for every path without a handler."""

    def prepare(self) -> None:
        """Refuse the request."""
        raise HTTPError(http.client.NOT_FOUND)


ROUTES: list[tuple[str, type[SecurityHeaders]]] = [
    ("/liveness", Liveness),
    ("/readiness", Readiness),
    ("/metrics", Metrics),
    ("/status", Status),
]
"""Paths and handlers, in the form of a ``panel serve --plugins`` module."""


def status_page(sentence: str, registry: CollectorRegistry) -> str:
    """Return a page with a sentence and a table of metrics, without histogram buckets."""
    rows = "".join(
        f"<tr><th scope=row style='text-align:left;font-weight:normal'>{escape(label)}</th>"
        f"<td style='text-align:right;padding-left:2em'>{value:,.10g}</td></tr>"
        for label, value in _samples(registry)
    )
    head = "<meta charset=utf-8><meta name=viewport content='width=device-width'><title>Escape Explorer: status</title>"
    body = f"<h1 style='font-size:20px'>Escape Explorer</h1><p>{escape(sentence)}</p><table>{rows}</table>"
    return f"<!doctype html><html lang=en><head>{head}</head><body style='font-family:sans-serif;margin:2em'>{body}</body></html>"


def _samples(registry: CollectorRegistry) -> list[tuple[str, float]]:
    """Return label and value of each metric. Buckets and times of creation say nothing to people."""
    return [
        (_label(family.documentation, sample), sample.value)
        for family in registry.collect()
        for sample in family.samples
        if not sample.name.endswith(("_created", "_bucket"))
    ]


def _label(documentation: str, sample: Any) -> str:
    """Return the documentation of a metric, with the values of the sample's labels in parentheses."""
    details = [value for value in sample.labels.values() if value]
    # A histogram also has a sample with the sum.
    if sample.name.endswith("_count"):
        details.append("count")
    return f"{documentation} ({', '.join(details)})" if details else documentation
