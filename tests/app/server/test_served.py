"""A real server, from its start to its end: tests in the order of its life."""

from __future__ import annotations

import asyncio
import http.client
import json
import os
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlencode

import pytest

from benchmarks.visitors import Channel

ROOT = Path(__file__).parents[3]
START_SECONDS = 240
# Bounded orbits, followed for longer than any test takes.
LONG_MAP = {"case": "III", "h": "0.26", "resolution": "900", "t_max": "1e+06", "plane": "x_y"}


@dataclass
class Served:
    """A server on loopback, with room for two sessions."""

    port: int
    process: subprocess.Popen[bytes]
    log: Path
    pages: list[str] = field(default_factory=list)
    told: float = 0.0

    def get(self, path: str, **headers: str) -> tuple[int, str, http.client.HTTPMessage]:
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", headers=headers)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status, answer.read().decode(), answer.headers
        except urllib.error.HTTPError as refusal:
            with refusal:
                return refusal.code, refusal.read().decode(), refusal.headers

    def figure(self, name: str) -> float:
        lines = dict(line.rsplit(" ", 1) for line in self.get("/metrics")[1].splitlines() if not line.startswith("#"))
        return float(lines[f"escape_explorer_{name}"])

    def wait_for(self, path: str, status: int) -> None:
        end = time.monotonic() + START_SECONDS
        while time.monotonic() < end and self.process.poll() is None:
            try:
                if self.get(path)[0] == status:
                    return
            except OSError:
                pass
            time.sleep(0.1)
        raise TimeoutError(f"{path} has not come to {status}: {self.log.read_text()}")


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    log = tmp_path_factory.mktemp("served") / "log"
    command = [sys.executable, "-m", "panel", "serve", "app", "--address", "127.0.0.1", "--port", str(port)]
    environment = {**os.environ, "ESCAPE_EXPLORER_LOG": "json", "ESCAPE_EXPLORER_MOST_SESSIONS": "2"}
    with log.open("wb") as output:
        process = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=subprocess.DEVNULL, stderr=output)
    try:
        yield Served(port, process, log)
    finally:
        process.kill()
        process.wait(30)


def test_it_answers_before_the_kernels_are_there_and_is_ready_after(served: Served) -> None:
    served.wait_for("/liveness", 200)
    status, text, _ = served.get("/readiness")
    assert (status, json.loads(text)["sentence"]) in {(503, "The integrators are being compiled."), (200, "Ready.")}
    served.wait_for("/readiness", 200)
    assert served.figure("kernels_ready") == 1


@pytest.mark.parametrize("path", ["/status", "/metrics", "/readiness", "/nothing", "/static/js/bokeh.min.js"])
def test_every_answer_has_the_headers(served: Served, path: str) -> None:
    _, _, headers = served.get(path)
    assert headers["Content-Security-Policy"].startswith("default-src 'self'; ")
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"]
    assert headers["Permissions-Policy"]


def test_figures_come_in_the_text_form_of_prometheus_and_as_a_table(served: Served) -> None:
    assert served.get("/metrics")[2]["Content-Type"].startswith("text/plain; version=")
    assert "Sessions that are open" in served.get("/status")[1]


def test_a_page_of_another_origin_gets_no_connection(served: Served) -> None:
    upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "x"}
    protocol = {"Sec-WebSocket-Protocol": "bokeh, token"}
    # Not by urllib, which would ask for the connection to be closed.
    connection = http.client.HTTPConnection("127.0.0.1", served.port, timeout=60)
    connection.request("GET", "/app/ws", headers={"Origin": "https://elsewhere.example", **upgrade, **protocol})
    assert connection.getresponse().status == 403
    connection.close()


def test_when_all_places_are_taken_visitors_are_sent_away_with_a_sentence(served: Served) -> None:
    opened = [served.get(f"/app?{urlencode(LONG_MAP)}") for _ in range(2)]
    assert [status for status, _, _ in opened] == [200, 200]
    served.pages = [page for _, page, _ in opened]
    status, text, _ = served.get("/app")
    assert status == 503
    assert "All 2 places are taken." in text
    assert served.get("/readiness")[0] == 503
    assert served.figure("sessions_open") == 2
    assert served.figure("pages_refused_total") == 1


def test_it_stops_within_five_seconds_of_being_told_though_it_computes(served: Served) -> None:
    # In a thread: the browser tests leave a loop running in this one.
    with ThreadPoolExecutor(1) as thread:
        thread.submit(lambda: asyncio.run(stop_while_computing(served))).result()
    assert served.process.wait(30) == 0
    assert time.monotonic() - served.told < 5.0


def test_its_log_is_json_and_without_a_traceback(served: Served) -> None:
    lines = [line for line in served.log.read_text().splitlines() if line.startswith("{")]
    told = [json.loads(line) for line in lines]
    assert told[-1]["message"] == "stopping"
    assert [record for record in told if "traceback" in record] == []


async def stop_while_computing(served: Served) -> None:
    """A visitor asks for a map that takes long; while it is computed, the server is told to stop."""
    channel = await Channel.connect(f"http://127.0.0.1:{served.port}/app", served.pages[0])
    async for kind, _ in channel.messages():
        if kind == "ACK":
            channel.send("PULL-DOC-REQ", {})
        elif kind == "PULL-DOC-REPLY":
            channel.tell("document_ready")
        elif kind == "PATCH-DOC" and served.told == 0.0 and served.figure("jobs_in_flight") >= 1:
            served.told = time.monotonic()
            served.process.send_signal(signal.SIGTERM)
    channel.close()
    assert served.told, "the map was never begun"
