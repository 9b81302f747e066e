"""Connections are limited in number and size, and closed when nothing arrives."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Any
from unittest.mock import patch

import pytest
from tornado.httpclient import AsyncHTTPClient
from tornado.iostream import IOStream
from tornado.testing import bind_unused_port
from tornado.web import Application, RequestHandler
from tornado.websocket import WebSocketHandler, websocket_connect

from app.runtime.process_state import ProcessState
from app.server.admission import RETRY_SECONDS
from app.server.batched_stream import BatchedStream
from app.server.limited_http_server import CONNECTIONS_PER_PAGE, LIMITS, MOST_REFUSALS, LimitedHTTPServer
from tests.app.other_loop import run_on_new_loop
from tests.waiting import SECONDS

REQUEST = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"
Scenario = Callable[[int], Awaitable[None]]


class Answer(RequestHandler):
    def get(self) -> None:
        self.write("here")


class Origin(RequestHandler):
    """Answers with the scheme and address of the client, as the server sees them."""

    def get(self) -> None:
        self.write(f"{self.request.protocol} {self.request.remote_ip}")


class Burst(WebSocketHandler):
    """Answers a message with ten messages."""

    def on_message(self, message: str | bytes) -> None:
        for number in range(10):
            self.write_message(f"{message!r} {number}")


@pytest.fixture
def state(start_state: Callable[..., ProcessState]) -> ProcessState:
    return start_state(most_connections=CONNECTIONS_PER_PAGE + 1, pages_per_address=1)


@asynccontextmanager
async def served(**options: Any) -> AsyncIterator[int]:
    """Yield the port of a server."""
    server = LimitedHTTPServer(Application([("/", Answer), ("/origin", Origin), ("/ws", Burst)]), **options)
    listening, port = bind_unused_port()
    server.add_socket(listening)
    try:
        yield port
    finally:
        server.stop()
        await server.close_all_connections()


def run(scenario: Scenario, **options: Any) -> None:
    async def with_server() -> None:
        async with asyncio.timeout(SECONDS), served(**options) as port:
            await scenario(port)

    run_on_new_loop(with_server)


async def status(port: int) -> int:
    """Return the status of the answer to a new connection, which stays open unless it is refused; 0 without an answer."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    _kept.append(writer)
    writer.write(REQUEST)
    try:
        line = await reader.readline()
    except ConnectionResetError:
        return 0
    return int(line.split()[1]) if line else 0


_kept: list[asyncio.StreamWriter] = []


async def close_kept() -> None:
    for writer in _kept:
        writer.close()
        await writer.wait_closed()
    _kept.clear()


def refused(state: ProcessState) -> float:
    count = state.metrics.registry.get_sample_value("escape_explorer_connections_refused_total")
    assert count is not None
    return count


@pytest.mark.parametrize(("xheaders", "most"), [(False, CONNECTIONS_PER_PAGE), (True, CONNECTIONS_PER_PAGE + 1)])
def test_connections_are_limited(xheaders: bool, most: int, state: ProcessState) -> None:
    async def scenario(port: int) -> None:
        assert [await status(port) for _ in range(most + 1)] == [200] * most + [503]
        assert refused(state) == 1
        await close_kept()
        assert await status(port) == 200
        await close_kept()

    run(scenario, xheaders=xheaders)


def test_a_refused_connection_says_when_to_come_again_and_ends(state: ProcessState) -> None:
    async def scenario(port: int) -> None:
        for _ in range(CONNECTIONS_PER_PAGE):
            await status(port)
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(REQUEST)
        answer = await reader.read()
        assert f"Retry-After: {RETRY_SECONDS}\r\n".encode() in answer
        assert b"Content-Security-Policy: default-src 'self'" in answer
        _kept.append(writer)
        await close_kept()

    run(scenario)


def test_refusals_beyond_their_own_limit_are_closed(state: ProcessState) -> None:
    async def scenario(port: int) -> None:
        for _ in range(CONNECTIONS_PER_PAGE):
            await status(port)
        # These connections send nothing, so that their refusals last.
        opened = [await asyncio.open_connection("127.0.0.1", port) for _ in range(MOST_REFUSALS + 1)]
        assert await opened[-1][0].read() == b""
        _kept.extend(writer for _, writer in opened)
        await close_kept()

    run(scenario)


def test_websockets_do_not_count_as_connections(state: ProcessState) -> None:
    async def scenario(port: int) -> None:
        sockets = [await websocket_connect(f"ws://127.0.0.1:{port}/ws") for _ in range(CONNECTIONS_PER_PAGE + 3)]
        assert refused(state) == 0
        for socket in sockets:
            socket.close()
            assert await socket.read_message() is None

    run(scenario)


def test_the_messages_of_an_iteration_are_sent_with_two_system_calls(state: ProcessState) -> None:
    async def scenario(port: int) -> None:
        socket = await websocket_connect(f"ws://127.0.0.1:{port}/ws")
        sent: list[int] = []

        def write_to_fd(stream: IOStream, data: memoryview) -> int:
            if isinstance(stream, BatchedStream):
                sent.append(len(data))
            return int(write(stream, data))

        write = IOStream.write_to_fd
        with patch.object(IOStream, "write_to_fd", write_to_fd):
            await socket.write_message("any")
            assert [await socket.read_message() for _ in range(10)] == [f"'any' {number}" for number in range(10)]
        assert len(sent) == 2
        socket.close()
        assert await socket.read_message() is None

    run(scenario)


@pytest.mark.parametrize("sent", [b"", REQUEST[:-2]], ids=["nothing", "half the headers"])
@pytest.mark.usefixtures("state")
def test_connections_without_a_whole_request_are_closed(sent: bytes) -> None:
    async def scenario(port: int) -> None:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(sent)
        assert await reader.read() == b""
        writer.close()

    run(scenario, idle_connection_timeout=0.05)


@pytest.mark.usefixtures("state")
def test_large_headers_are_refused_with_an_answer() -> None:
    async def scenario(port: int) -> None:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(REQUEST[:-2] + b"X: " + b"x" * LIMITS["max_header_size"])
        assert (await reader.read()).startswith(b"HTTP/1.1 431 Request Header Fields Too Large\r\n")
        writer.close()

    run(scenario)


@pytest.mark.parametrize(("xheaders", "origin"), [(True, "https 192.0.2.1"), (False, "http 127.0.0.1")])
@pytest.mark.usefixtures("state")
def test_address_and_scheme_are_those_of_the_last_proxy(xheaders: bool, origin: str) -> None:
    headers = {
        "X-Forwarded-For": "198.51.100.1, 192.0.2.1",
        "X-Forwarded-Proto": "http, https",
        "X-Real-Ip": "198.51.100.2",
        "X-Scheme": "http",
    }

    async def scenario(port: int) -> None:
        answer = await AsyncHTTPClient().fetch(f"http://127.0.0.1:{port}/origin", headers=headers)
        assert answer.body.decode() == origin

    run(scenario, xheaders=xheaders)
