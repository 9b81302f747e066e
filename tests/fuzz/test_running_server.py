"""Random messages and requests cause no traceback and no hang in a server, leave no memory behind, and other pages still open."""

from __future__ import annotations

import asyncio
import json
import logging
from pathlib import Path

import pytest
from tornado.websocket import WebSocketClosedError

from tests.app.other_loop import run_on_new_loop
from tests.app.server.mounted_routes import mounted_routes
from tests.browser.served_app import RunningApp
from tests.fuzz.attacked_server import fetch_page, open_page, resting_memory, tracebacks
from tests.fuzz.random_messages import RandomMessages
from tests.fuzz.random_requests import RandomRequests
from tests.page_channel import Channel
from tests.waiting import SECONDS

log = logging.getLogger(__name__)

# Number of messages of a connection before it is cut and the next connection begins. Every third connection has a new page.
LIFE = 600
CONNECTIONS_PER_PAGE = 3
BETWEEN_SYNCHRONIZATIONS = 25
VISITORS = 4
PARTS = 3
CLIENTS = 8
LARGEST_GROWTH_BY_MESSAGES, LARGEST_GROWTH_BY_REQUESTS = 1.3, 1.15


class Visitor:
    """Opens the connections of one visitor, one after another."""

    def __init__(self, address: str, seed: int) -> None:
        self._address, self._messages = address, RandomMessages(seed)
        self._page = ""
        self.sent = 0

    async def run(self, count: int) -> None:
        connections = 0
        while self.sent < count:
            if connections % CONNECTIONS_PER_PAGE == 0:
                self._page = await fetch_page(self._address)
            connections += 1
            channel = await Channel.connect(self._address, self._page)
            reader = asyncio.create_task(self._read(channel))
            try:
                await self._send_all(channel, reader, min(LIFE, count - self.sent))
            except WebSocketClosedError:
                # The server has closed the connection, as it should after many invalid messages.
                pass
            finally:
                channel.close()
                reader.cancel()
                await asyncio.wait([reader])

    async def _send_all(self, channel: Channel, reader: asyncio.Task[None], count: int) -> None:
        self._opened, self._answered = asyncio.Event(), asyncio.Event()
        await self._wait(self._opened, reader)
        for number in range(count):
            self.sent += 1
            if self._messages.random.random() < 0.005:
                parts = self._messages.wrong_parts()
                channel.write(*parts)
                if len(parts) != PARTS:
                    # These parts shift the parts of all later messages, so the connection is of no further use.
                    return
            else:
                channel.send("PATCH-DOC", self._messages.patch())
            if number % BETWEEN_SYNCHRONIZATIONS == 0 and self._messages.random.random() < 0.9:
                self._answered.clear()
                channel.send("SERVER-INFO-REQ", {})
                await self._wait(self._answered, reader)

    async def _wait(self, event: asyncio.Event, reader: asyncio.Task[None]) -> None:
        """Wait for an event or the end of the connection. TimeoutError if the server hangs."""
        waiting = asyncio.create_task(event.wait())
        done, _ = await asyncio.wait([waiting, reader], timeout=SECONDS, return_when=asyncio.FIRST_COMPLETED)
        waiting.cancel()
        if not done:
            raise TimeoutError("the server does not answer")
        if reader in done and not event.is_set():
            raise WebSocketClosedError

    async def _read(self, channel: Channel) -> None:
        async for kind, content in channel.messages():
            parsed = json.loads(content)
            if kind == "ACK":
                channel.send("PULL-DOC-REQ", {})
            elif kind == "SERVER-INFO-REPLY":
                self._answered.set()
            elif kind == "PULL-DOC-REPLY":
                # Forget the models of earlier pages, which the server would refuse.
                self._messages.models.clear()
                self._messages.learn(parsed)
                channel.emit("document_ready")
                self._opened.set()
            else:
                self._messages.learn(parsed)


def send_messages(app: RunningApp, count: int, seed: int) -> int:
    async def run() -> int:
        visitors = [Visitor(app.address, seed + number) for number in range(VISITORS)]
        await asyncio.gather(*(visitor.run(count // VISITORS) for visitor in visitors))
        await asyncio.wait_for(open_page(app.address), SECONDS)
        return sum(visitor.sent for visitor in visitors)

    return run_on_new_loop(run)


async def send(port: int, request: bytes) -> bytes:
    """Send a request, and return the first line of the answer; empty if the server closes the connection."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        writer.write(request)
        # Without an end, the server would wait for the rest of an incomplete request.
        writer.write_eof()
        first = (await asyncio.wait_for(reader.read(), SECONDS)).partition(b"\r\n")[0]
        await asyncio.wait_for(writer.drain(), SECONDS)
    except ConnectionError:
        return b""
    finally:
        writer.close()
    return first


def send_requests(app: RunningApp, requests: RandomRequests, count: int) -> dict[bytes, int]:
    """Send requests, some at the same time, and return how often each status was answered."""
    port, answers = int(app.root.rpartition(":")[2]), dict[bytes, int]()

    async def client() -> None:
        for _ in range(count // CLIENTS):
            status = (await send(port, requests.make()))[9:12]
            answers[status] = answers.get(status, 0) + 1

    async def run() -> None:
        await asyncio.gather(*(client() for _ in range(CLIENTS)))

    run_on_new_loop(run)
    return answers


@pytest.mark.parametrize(
    "count", [pytest.param(4_000, marks=pytest.mark.slow), pytest.param(100_000, marks=pytest.mark.exhaustive)]
)
def test_many_random_messages_and_requests_leave_no_memory_behind(count: int, served: tuple[RunningApp, Path]) -> None:
    (app, output), requests = served, RandomRequests(mounted_routes()[1:], seed=7)
    # The first half fills the caches.
    assert send_messages(app, count // 2, seed=100) == count // 2
    answers = send_requests(app, requests, count // 2)
    early = resting_memory(app)
    assert send_messages(app, count // 2, seed=200) == count // 2
    late = resting_memory(app)
    answers |= send_requests(app, requests, count // 2)
    latest = resting_memory(app)
    run_on_new_loop(lambda: asyncio.wait_for(open_page(app.address), SECONDS))
    sizes = [round(each / 2**20) for each in (early, late, latest)]
    log.info("%d messages, answers %s, resident memory of %s MB", count, answers, sizes)
    assert tracebacks(output) == []
    assert {status for status in answers if status.startswith(b"5")} <= {b"503", b"505"}
    assert late < LARGEST_GROWTH_BY_MESSAGES * early
    assert latest < LARGEST_GROWTH_BY_REQUESTS * late
