"""A real server answers and refuses requests from its start to its stop. The tests depend on their order."""

from __future__ import annotations

import gzip
import http.client
import json
import re
import signal
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlencode

import pytest
from bokeh.util.token import generate_jwt_token, generate_session_id

from app.browser.module_files import ADDRESS, KERNELS_ADDRESS
from engine.integrator.portable_kernels import kernel_module
from tests.app.other_loop import run_on_new_loop
from tests.browser.served_app import RunningApp, started_app
from tests.page_channel import Channel
from tests.waiting import SECONDS

# A map of bounded orbits, which takes longer than any test.
LONG_MAP = {"case": "III", "h": "0.26", "resolution": "900", "t_max": "1e+06", "plane": "x_y"}
MARKUP = {"V": '"><script>1</script>', "h": "0.25"}


@dataclass
class Served:
    """A server on the loopback interface with at most two sessions."""

    running: RunningApp
    log: Path
    pages: list[str] = field(default_factory=list)
    stopped_at: float = 0.0

    def get(self, path: str, **headers: str) -> tuple[int, str, http.client.HTTPMessage]:
        request = urllib.request.Request(f"{self.running.root}{path}", headers=headers)
        try:
            with urllib.request.urlopen(request, timeout=SECONDS) as answer:
                return answer.status, answer.read().decode(errors="replace"), answer.headers
        except urllib.error.HTTPError as refusal:
            with refusal:
                return refusal.code, refusal.read().decode(), refusal.headers

    def metric(self, name: str) -> float:
        return self.running.figure(name)

    @property
    def host(self) -> str:
        return self.running.root.removeprefix("http://")


@contextmanager
def serving(log: Path, *command: str) -> Iterator[Served]:
    """Run a command that serves the page, and yield the server."""
    variables = {"ESCAPE_EXPLORER_LOG": "json", "ESCAPE_EXPLORER_MOST_SESSIONS": "2"}
    with started_app(log, *command, variables=variables) as running:
        yield Served(running, log)


@pytest.fixture(scope="module")
def _default_sigint() -> Iterator[None]:
    """Restore Python's handler of SIGINT. Processes started in the background ignore SIGINT, and so would the server."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory, _default_sigint: None) -> Iterator[Served]:
    with serving(tmp_path_factory.mktemp("served") / "log", "cli", "serve") as server:
        yield server


def test_server_answers_during_compilation_and_is_ready_afterwards(served: Served) -> None:
    status, text, _ = served.get("/readiness")
    assert (status, json.loads(text)["sentence"]) in {(503, "The integrators are being compiled."), (200, "Ready.")}
    served.running.output.wait_for('"ready"')
    assert served.get("/readiness")[0] == 200
    assert served.metric("kernels_ready") == 1


def test_responses_have_security_headers(served: Served) -> None:
    files = ("/static/js/bokeh.min.js", "/app/static/theme.css", "/favicon.ico")
    for path in ("/status", "/metrics", "/readiness", "/nothing", *files):
        _, _, headers = served.get(path)
        assert headers["Content-Security-Policy"].startswith("default-src 'self'; "), path
        assert headers["X-Content-Type-Options"] == "nosniff", path
        assert headers["Referrer-Policy"], path
        assert headers["Permissions-Policy"], path
        assert "Server" not in headers, path


def test_modules_of_the_engine_in_the_browser_can_be_cached(served: Served) -> None:
    status, text, headers = served.get(f"/{ADDRESS}")
    assert (status, headers["Content-Type"].endswith("/javascript")) == (200, True)
    assert "import" in text
    assert int(headers["Cache-Control"].partition("max-age=")[2]) > 1e7
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert served.get(f"/{ADDRESS.replace('main', 'nothing')}")[0] == 404
    assert served.get("/browser/0123456789abcdef/main.js")[0] == 404


def test_kernels_can_be_cached_and_are_compressed_on_request(served: Served) -> None:
    for headers in ({}, {"Accept-Encoding": "gzip"}):
        request = urllib.request.Request(f"{served.running.root}/{KERNELS_ADDRESS}", headers=headers)
        with urllib.request.urlopen(request, timeout=SECONDS) as answer:
            content = answer.read()
            assert answer.headers["Content-Type"] == "application/wasm"
            assert int(answer.headers["Cache-Control"].partition("max-age=")[2]) > 1e7
            assert answer.headers["X-Content-Type-Options"] == "nosniff"
        assert (gzip.decompress(content) if headers else content) == kernel_module()


def test_scripts_are_compressed_on_request(served: Served) -> None:
    for path in ("/static/js/bokeh.min.js", "/static/extensions/panel/panel.min.js", f"/{ADDRESS}"):
        contents, tags = [], {}
        part = {"Range": "bytes=0-"}
        for accepted, more in (("", {}), ("br, gzip;q=0", {}), ("br, GZIP; q=0.5", {}), ("*", {}), ("gzip", part)):
            request = urllib.request.Request(f"{served.running.root}{path}", headers={"Accept-Encoding": accepted, **more})
            with urllib.request.urlopen(request, timeout=SECONDS) as answer:
                content = answer.read()
                is_compressed = answer.headers["Content-Encoding"] == "gzip"
                assert len(content) == int(answer.headers["Content-Length"])
                assert answer.headers["Vary"] == "Accept-Encoding"
            assert is_compressed == (accepted in {"br, GZIP; q=0.5", "*"}), accepted
            contents.append(gzip.decompress(content) if is_compressed else content)
            tags.setdefault(is_compressed, set()).add(answer.headers["ETag"])
        assert contents == [contents[0]] * len(contents)
        # The tags of both representations differ, so a cache does not take one for the other.
        assert [len(tags[is_compressed]) for is_compressed in (False, True)] == [1, 1]
        assert tags[False] != tags[True]
        [tag] = tags[True]
        assert served.get(path, **{"Accept-Encoding": "gzip", "If-None-Match": tag})[0] == 304


def test_metrics_are_shown_for_prometheus_and_as_a_table(served: Served) -> None:
    assert served.get("/metrics")[2]["Content-Type"].startswith("text/plain; version=")
    page = served.get("/status")[1]
    assert "<p>Ready.</p>" in page
    assert "Open sessions" in page


@pytest.mark.parametrize(
    "path",
    [
        "/app/autoload.js?bokeh-autoload-element=x", "/app/metadata", "/app/", "/session_info", "//app", "/static/%00",
        *(f"/components/{module}/x/_css/x" for module in ("unittest.__main__", "cli.__main__", "antigravity")),
    ],
)  # fmt: skip
def test_routes_that_the_page_does_not_need_are_refused(path: str, served: Served) -> None:
    assert served.get(path)[0] == 404
    assert served.get("/liveness")[0] == 200
    assert served.metric("sessions_created_total") == 0


@pytest.mark.parametrize(
    ("path", "host", "status"),
    [
        ("/app", "elsewhere.example:80", 421),
        ("/", "elsewhere.example", 421),
        ("/app", "127.0.0.1.elsewhere.example", 421),
        ("/static/js/bokeh.min.js", "localhost:1", 200),
        # Probes ask for whatever host their network gives them.
        ("/liveness", "elsewhere.example", 200),
    ],
)
def test_other_hosts_are_refused(path: str, host: str, status: int, served: Served) -> None:
    assert served.get(path, Host=host)[0] == status
    assert served.metric("sessions_created_total") == 0


def test_root_redirects_to_the_page_with_the_query(served: Served) -> None:
    connection = http.client.HTTPConnection(served.host, timeout=60)
    connection.request("GET", "/?case=III&h=0.3")
    with connection.getresponse() as answer:
        assert (answer.status, answer.headers["Location"]) == (302, "./app?case=III&h=0.3")
    connection.close()


def test_token_of_another_server_is_refused(served: Served) -> None:
    token = generate_jwt_token(generate_session_id(), signed=False, extra_payload={"arguments": {"h": ["0" * 2**20]}})
    assert upgrade(served, token, f"http://{served.host}") == 403
    assert served.metric("sessions_created_total") == 0


def test_full_server_refuses_pages_with_a_sentence(served: Served) -> None:
    opened = [served.get(f"/app?{urlencode(link)}") for link in (LONG_MAP, MARKUP)]
    assert [status for status, _, _ in opened] == [200, 200]
    served.pages = [page for _, page, _ in opened]
    for _, page, headers in opened:
        check_nonce(page, headers["Content-Security-Policy"])
    status, text, headers = served.get("/app")
    assert status == 503
    assert "All 2 places are taken." in text
    # The refused page asks again by itself.
    assert f"http-equiv=refresh content={headers['Retry-After']}>" in text
    assert served.get("/readiness")[0] == 503
    assert "<p>All 2 places are taken.</p>" in served.get("/status")[1]
    assert served.metric("sessions_open") == 2
    assert served.metric("pages_refused_total") == 1


def test_texts_of_a_link_are_no_markup_in_the_head_of_its_page(served: Served) -> None:
    assert "<script>1" not in served.pages[1]
    assert 'property="og:description" content="Typed potential on the plane (x, px) at h = 0.25: ' in served.pages[1]


def test_websocket_of_another_origin_is_refused(served: Served) -> None:
    token = re.search(r'"token":"([^"]+)"', served.pages[0])
    assert token is not None
    assert upgrade(served, token[1], "https://elsewhere.example") == 403
    assert upgrade(served, token[1], f"http://{served.host}") == 101


def check_stop(served: Served, number: signal.Signals) -> None:
    """Check that a signal ends the server within seconds, although a map that takes minutes is being computed."""
    run_on_new_loop(lambda: stop_during_a_map(served, number))
    assert served.running.process.wait(SECONDS) == 0
    assert time.monotonic() - served.stopped_at < 30.0
    served.running.output.close()
    check_log(served)


def test_ctrl_c_stops_the_server_during_a_computation(served: Served) -> None:
    check_stop(served, signal.SIGINT)


@pytest.mark.slow
def test_sigterm_stops_panel_during_a_computation(tmp_path: Path) -> None:
    with serving(tmp_path / "log", "panel", "serve", "app") as server:
        server.pages = [server.get(f"/app?{urlencode(LONG_MAP)}")[1]]
        check_stop(server, signal.SIGTERM)


def check_log(served: Served) -> None:
    """Check that the last record is that of the stop, and no record has a traceback."""
    text = served.log.read_text()
    records = [json.loads(line) for line in text.splitlines() if line.startswith("{")]
    assert records[-1]["message"] == "stopping"
    assert "Traceback" not in text
    assert [record for record in records if "traceback" in record] == []


def upgrade(served: Served, token: str, origin: str) -> int:
    """Return the status of a request for a WebSocket."""
    headers = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "x"}
    # urllib would send "Connection: close".
    connection = http.client.HTTPConnection(served.host, timeout=SECONDS)
    try:
        connection.request("GET", "/app/ws", headers={**headers, "Origin": origin, "Sec-WebSocket-Protocol": f"bokeh, {token}"})
        return connection.getresponse().status
    finally:
        connection.close()


def check_nonce(page: str, policy: str) -> None:
    """Check that all scripts of a page have the nonce of its policy."""
    [nonce] = set(re.findall(r'<script nonce="([^"]+)"', page))
    assert f"'nonce-{nonce}'" in policy
    assert page.count("<script") == page.count("<script nonce=")


async def stop_during_a_map(served: Served, number: signal.Signals) -> None:
    """Request a long map and send a signal while it is computed."""
    channel = await Channel.connect(served.running.address, served.pages[0])
    async for kind, _ in channel.messages():
        if kind == "ACK":
            channel.send("PULL-DOC-REQ", {})
        elif kind == "PULL-DOC-REPLY":
            channel.emit("document_ready")
        elif kind == "PATCH-DOC" and served.stopped_at == 0.0 and served.metric("jobs_in_flight") >= 1:
            served.stopped_at = time.monotonic()
            served.running.process.send_signal(number)
    channel.close()
    assert served.stopped_at, "the map was never started"
