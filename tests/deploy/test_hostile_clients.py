"""Whatever one client sends through nginx, the next requests of other visitors are answered by all servers."""

from __future__ import annotations

import asyncio
import http.client
import ssl
import threading
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager

import pytest
from tornado.testing import bind_unused_port
from tornado.web import Application, RequestHandler
from tornado.websocket import WebSocketHandler

from app.server.limited_http_server import LimitedHTTPServer
from tests.browser.served_app import free_port
from tests.deploy.hostile_clients import CLIENTS
from tests.deploy.proxy import ADDRESS_HEADER, Proxy, authorization, nginx, proxied
from tests.waiting import SECONDS

pytestmark = pytest.mark.skipif(nginx() is None, reason="nginx is not installed")
# Each server would miss all of so many requests once in 30 000 runs.
REQUESTS = 16


class Page(RequestHandler):
    """Answers with the port of the server, or, with ``?wait``, only after the client has left."""

    def initialize(self, port: int) -> None:
        self._port, self._left = port, asyncio.Event()

    async def get(self) -> None:
        if self.request.query == "wait":
            await self._left.wait()
        self.write(str(self._port))

    def on_connection_close(self) -> None:
        self._left.set()


class Socket(WebSocketHandler):
    """Accepts WebSockets."""


@contextmanager
def limited_server() -> Iterator[int]:
    """Run the HTTP server of the explorer with another application, and yield its port."""
    listening, port = bind_unused_port()
    loop, stopped = asyncio.new_event_loop(), asyncio.Event()

    async def serve() -> None:
        server = LimitedHTTPServer(Application([("/app", Page, {"port": port}), ("/app/ws", Socket)]), xheaders=True)
        server.add_socket(listening)
        await stopped.wait()
        server.stop()
        await server.close_all_connections()

    thread = threading.Thread(target=lambda: loop.run_until_complete(serve()))
    thread.start()
    try:
        yield port
    finally:
        loop.call_soon_threadsafe(stopped.set)
        thread.join()
        loop.close()


@pytest.fixture(scope="module")
def proxy(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Proxy]:
    """Yield a proxy in front of two servers."""
    with ExitStack() as stack:
        backends = stack.enter_context(limited_server()), stack.enter_context(limited_server())
        yield stack.enter_context(proxied(nginx() or "", tmp_path_factory.mktemp("hostile"), free_port(), backends))


def ask(proxy: Proxy, address: str) -> tuple[int, bytes]:
    with closing(
        http.client.HTTPSConnection("127.0.0.1", proxy.port, timeout=SECONDS, context=proxy.ssl_context())
    ) as connection:
        connection.request("GET", "/app", headers=authorization() | {ADDRESS_HEADER: address})
        answer = connection.getresponse()
        return answer.status, answer.read()


@pytest.mark.parametrize("name", CLIENTS)
def test_other_visitors_are_answered_by_both_servers(name: str, proxy: Proxy) -> None:
    kept: list[ssl.SSLSocket] = []
    try:
        # Without a cookie, nginx chooses a server at random for each request.
        for _ in range(REQUESTS):
            kept += CLIENTS[name](proxy)
        answers = [ask(proxy, f"198.51.100.{k}") for k in range(REQUESTS)]
    finally:
        for connection in kept:
            connection.close()
    assert {status for status, _ in answers} == {200}
    assert len({port for _, port in answers}) == 2
