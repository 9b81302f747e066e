"""The explorer works behind nginx with TLS and a password, configured by `deploy/nginx.conf`."""

from __future__ import annotations

import asyncio
import http.client
import http.server
import json
import re
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from tests.app.other_loop import run_on_new_loop
from tests.browser.served_app import PANEL, READY, free_port, started_app
from tests.deploy.proxy import ADDRESS_HEADER, Proxy, authorization, nginx, proxied
from tests.waiting import SECONDS

pytestmark = pytest.mark.skipif(nginx() is None, reason="nginx is not installed")
# Marks tests that start the explorer. The other tests use servers that answer with their port.
with_explorer = pytest.mark.slow
FORGED = (
    "X-Forwarded-For",
    "X-Real-Ip",
    "X-Forwarded-Proto",
    "X-Scheme",
    "X-Forwarded-Host",
    "Forwarded",
)


@pytest.fixture(scope="module")
def proxy(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Proxy]:
    """Yield a proxy in front of the explorer."""
    folder, port, backend = tmp_path_factory.mktemp("nginx"), free_port(), free_port()
    with (
        explorer(folder / "log", backend, f"127.0.0.1:{port}"),
        proxied(nginx() or "", folder, port, (backend, backend)) as proxy,
    ):
        yield proxy


@pytest.fixture(scope="module")
def proxy_before_two(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Proxy]:
    """Yield a proxy in front of two servers that answer with their port."""
    with ExitStack() as stack:
        backends = stack.enter_context(port_server()), stack.enter_context(port_server())
        yield stack.enter_context(proxied(nginx() or "", tmp_path_factory.mktemp("two"), free_port(), backends))


@contextmanager
def explorer(log: Path, port: int, origin: str) -> Iterator[None]:
    # Pages without a connection count until the end of the tests.
    options = ["--use-xheaders", f"--allow-websocket-origin={origin}", "--unused-session-lifetime=3600000"]
    with started_app(log, *PANEL, *options, port=port) as running:
        running.output.wait_for(READY)
        yield


class PortHandler(http.server.BaseHTTPRequestHandler):
    """Answers with the port of the server, or under ``/browser/`` with the headers of the request."""

    def do_GET(self) -> None:
        text = str(self.connection.getsockname()[1]).encode()
        if self.path.startswith("/browser/"):
            text = json.dumps(self.headers.items()).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(text)))
        self.end_headers()
        self.wfile.write(text)

    def log_message(self, format: str, *args: object) -> None:
        pass


@contextmanager
def port_server() -> Iterator[int]:
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), PortHandler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def ask(proxy: Proxy, path: str, headers: dict[str, str]) -> tuple[int, http.client.HTTPMessage, bytes]:
    connection = http.client.HTTPSConnection("127.0.0.1", proxy.port, timeout=SECONDS, context=proxy.ssl_context())
    try:
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        return answer.status, answer.headers, answer.read()
    finally:
        connection.close()


def open_page(proxy: Proxy) -> tuple[str, str]:
    """Open the page, and return its session token and its cookie."""
    status, headers, page = ask(proxy, "/app", authorization())
    assert status == 200
    token = re.search(rb'"token":"([^"]+)"', page)
    assert token is not None
    return token[1].decode(), headers["Set-Cookie"].split(";")[0]


async def first_message_header(proxy: Proxy, origin: str, password: dict[str, str]) -> dict[str, str]:
    """Open the page and its WebSocket, and return the header of the first message."""
    token, cookie = await asyncio.to_thread(open_page, proxy)
    request = HTTPRequest(
        f"wss://127.0.0.1:{proxy.port}/app/ws",
        headers={"Origin": origin, "Cookie": cookie, **password},
        ssl_options=proxy.ssl_context(),
    )
    socket = await websocket_connect(request, subprotocols=["bokeh", token])
    first = await socket.read_message()
    assert isinstance(first, str)
    socket.close()
    # Wait for the close: an open connection causes a warning when the loop ends.
    while await socket.read_message() is not None:
        pass
    header: dict[str, str] = json.loads(first)
    return header


@pytest.mark.parametrize("headers", [{}, authorization("guessed")], ids=["none", "wrong"])
def test_password_is_required(proxy_before_two: Proxy, headers: dict[str, str]) -> None:
    paths = ("/app", "/app/ws", "/static/js/bokeh.min.js")
    assert [ask(proxy_before_two, path, headers)[0] for path in paths] == [401] * 3


@with_explorer
def test_websocket_works_through_tls(proxy: Proxy) -> None:
    assert run_on_new_loop(lambda: first_message_header(proxy, proxy.origin, authorization()))["msgtype"] == "ACK"


@with_explorer
def test_websocket_of_another_origin_is_refused(proxy: Proxy) -> None:
    with pytest.raises(HTTPClientError) as refused:
        run_on_new_loop(lambda: first_message_header(proxy, "https://elsewhere.example.org", authorization()))
    assert refused.value.code == 403


def test_clients_cannot_forge_their_address(proxy_before_two: Proxy) -> None:
    forged = {**authorization(), ADDRESS_HEADER: "192.0.2.1"} | dict.fromkeys(FORGED, "198.51.100.1")
    arrived = json.loads(ask(proxy_before_two, "/browser/headers", forged)[2])
    named = [(name, value) for name, value in arrived if name in FORGED]
    assert named == [("X-Forwarded-For", "192.0.2.1"), ("X-Forwarded-Proto", "https")]


def test_http_redirects_to_https(proxy_before_two: Proxy) -> None:
    connection = http.client.HTTPConnection("127.0.0.1", proxy_before_two.plain_port, timeout=SECONDS)
    connection.request("GET", "/app?case=II")
    answer = connection.getresponse()
    answer.read()
    connection.close()
    assert (answer.status, answer.getheader("Location")) == (301, "https://127.0.0.1/app?case=II")


@pytest.mark.parametrize(
    "path",
    [
        *(f"/{name}" for name in ("liveness", "readiness", "metrics", "status", "nothing", "login")),
        *("/components/cli.__main__/x/_css/x", "/app/autoload.js", "/app/metadata", "/app/"),
    ],
)
def test_other_routes_are_not_public(path: str, proxy_before_two: Proxy) -> None:
    assert ask(proxy_before_two, path, authorization())[0] == 404


@pytest.mark.parametrize("path", ["/static/js/bokeh.min.js", "/app/static/gallery/owl.png", "/favicon.ico"])
def test_files_of_the_page_are_public(path: str, proxy_before_two: Proxy) -> None:
    assert ask(proxy_before_two, path, authorization())[0] == 200


def test_sessions_are_sticky_and_distributed(proxy_before_two: Proxy) -> None:
    backends = []
    for _ in range(16):
        status, headers, first = ask(proxy_before_two, "/app", authorization())
        assert status == 200
        cookie = {"Cookie": headers["Set-Cookie"].split(";")[0]}
        answers = [ask(proxy_before_two, path, {**authorization(), **cookie}) for path in ("/app/ws", "/static/a.js")]
        assert {answer for _, _, answer in answers} == {first}
        backends.append(first)
    # All sixteen sessions are on the same backend once in 33 000 runs.
    assert len(set(backends)) == 2


def test_page_rate_is_limited(proxy_before_two: Proxy) -> None:
    # Must be the last test in this file, as it exhausts the limit of this address.
    statuses = [ask(proxy_before_two, "/app", authorization())[0] for _ in range(25)]
    assert statuses[-1] == 429
