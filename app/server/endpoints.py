"""The pages for whoever runs the server: is it alive, is it ready, what does it count."""

from __future__ import annotations

import http.client
from collections.abc import Callable
from html import escape
from typing import Any

from prometheus_client import CollectorRegistry
from prometheus_client.exposition import CONTENT_TYPE_LATEST, generate_latest
from tornado.web import RequestHandler

from app.runtime.health import why_not_ready
from app.runtime.metrics import process_metrics
from app.runtime.process_state import process_state

# Ours; a list of Bokeh's also holds those of Bokeh and Panel.
ROUTES: list[tuple[str, type[RequestHandler]]] = []


def _at[Page: type[RequestHandler]](path: str) -> Callable[[Page], Page]:
    def note(page: Page) -> Page:
        ROUTES.append((path, page))
        return page

    return note


class _Fresh(RequestHandler):
    """A page that nobody may keep."""

    def set_default_headers(self) -> None:
        """Said of every answer."""
        self.set_header("Cache-Control", "no-store")


@_at("/liveness")
class LivenessPage(_Fresh):
    """200 as long as the process answers; what Panel's own says."""

    def get(self) -> None:
        """JSON."""
        self.write({self.request.path: True})


@_at("/readiness")
class ReadinessPage(_Fresh):
    """200 when more visitors are welcome, 503 with a sentence when not."""

    def get(self) -> None:
        """JSON."""
        reason = why_not_ready(process_state())
        if reason is not None:
            self.set_status(http.client.SERVICE_UNAVAILABLE)
        self.write({"ready": reason is None, "sentence": reason or "Ready."})


@_at("/metrics")
class MetricsPage(_Fresh):
    """The figures in Prometheus' text form."""

    def get(self) -> None:
        """Text."""
        self.set_header("Content-Type", CONTENT_TYPE_LATEST)
        self.write(generate_latest(process_metrics().registry))


@_at("/status")
class StatusPage(_Fresh):
    """The figures in a table."""

    def get(self) -> None:
        """HTML."""
        self.write(status_page(why_not_ready(process_state()) or "Ready.", process_metrics().registry))


def status_page(sentence: str, registry: CollectorRegistry) -> str:
    """A page with a sentence and the registry's figures, without the steps of histograms."""
    rows = "".join(
        f"<tr><th scope=row style='text-align:left;font-weight:normal'>{escape(words)}</th>"
        f"<td style='text-align:right;padding-left:2em'>{value:,.10g}</td></tr>"
        for words, value in _readings(registry)
    )
    head = "<meta charset=utf-8><meta name=viewport content='width=device-width'><title>Escape Explorer: status</title>"
    body = f"<h1 style='font-size:20px'>Escape Explorer</h1><p>{escape(sentence)}</p><table>{rows}</table>"
    return f"<!doctype html><html lang=en><head>{head}</head><body style='font-family:sans-serif;margin:2em'>{body}</body></html>"


def _readings(registry: CollectorRegistry) -> list[tuple[str, float]]:
    found = []
    for family in registry.collect():
        for sample in family.samples:
            if not sample.name.endswith(("_created", "_bucket")):
                # A histogram has its count beside its sum.
                which = ", ".join([*filter(None, sample.labels.values()), *(["count"] if sample.name.endswith("_count") else [])])
                found.append((f"{family.documentation} ({which})" if which else family.documentation, sample.value))
    return found


def add_routes(patterns: list[Any]) -> None:
    """Put the pages among those that a server has besides its apps; twice is once."""
    patterns += [route for route in ROUTES if route not in patterns]
