"""Random messages to the running server: no traceback in its log, no hang, and other pages open as before."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Iterator
from pathlib import Path

import pytest
from tornado.httpclient import AsyncHTTPClient
from tornado.websocket import WebSocketClosedError

from benchmarks.simulated_sessions import Channel
from tests.app.other_loop import run_on_new_loop
from tests.browser.served_app import RunningApp, running_app
from tests.engine.jobs.inbox import wait_until
from tests.fuzz.random_messages import RandomMessages

log = logging.getLogger(__name__)

ANSWER_SECONDS = 60.0
# Messages of one connection before it is cut and the next one begins; every third one has a page of its own.
LIFE = 600
CONNECTIONS_PER_PAGE = 3
BETWEEN_SYNCHRONIZATIONS = 25
VISITORS = 4
# A map that takes little time.
LINK = "?case=I&h=0.3&resolution=48&t_max=100"
PARTS = 3
SMALL_CACHE = ("ESCAPE_EXPLORER_CACHE_BYTES", str(32 * 2**20))
"""A setting of the server: its cache of results is full after the first visitors."""


class Visitor:
    """Connections of one visitor, one after the other."""

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
                # The server has closed it, as it should after many invalid messages.
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
                for part in parts:
                    channel._socket.write_message(part, binary=isinstance(part, bytes))
                if len(parts) != PARTS:
                    # The rest of the connection would be one message shifted by these parts.
                    return
            else:
                channel.send("PATCH-DOC", self._messages.patch())
            if number % BETWEEN_SYNCHRONIZATIONS == 0 and self._messages.random.random() < 0.9:
                self._answered.clear()
                channel.send("SERVER-INFO-REQ", {})
                await self._wait(self._answered, reader)

    async def _wait(self, event: asyncio.Event, reader: asyncio.Task[None]) -> None:
        """Wait for an event or the end of the connection; TimeoutError if the server hangs."""
        waiting = asyncio.create_task(event.wait())
        done, _ = await asyncio.wait([waiting, reader], timeout=ANSWER_SECONDS, return_when=asyncio.FIRST_COMPLETED)
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
                # Models of earlier pages would be refused.
                self._messages.models.clear()
                self._messages.learn(parsed)
                channel.emit("document_ready")
                self._opened.set()
            else:
                self._messages.learn(parsed)


async def fetch_page(address: str) -> str:
    page = await AsyncHTTPClient().fetch(address + LINK, request_timeout=ANSWER_SECONDS)
    return page.body.decode()


async def open_page(address: str) -> None:
    """Open a page and wait for the first pixels of its map."""
    channel = await Channel.connect(address, await fetch_page(address))
    async for kind, content in channel.messages():
        if kind == "ACK":
            channel.send("PULL-DOC-REQ", {})
        elif kind == "PULL-DOC-REPLY":
            channel.emit("document_ready")
        elif kind == "PATCH-DOC" and '"escape_time"' in content:
            break
    channel.close()


@pytest.fixture
def served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[RunningApp, Path]]:
    monkeypatch.setenv(*SMALL_CACHE)
    # Reached in the first half of the long run.
    monkeypatch.setenv("ESCAPE_EXPLORER_COMPILED_OPERATIONS", "50000")
    log = tmp_path / "log"
    with running_app(log, "--unused-session-lifetime", "5000", "--check-unused-sessions", "500") as app:
        yield app, log


def attack(app: RunningApp, count: int, seed: int) -> int:
    async def run() -> int:
        visitors = [Visitor(app.address, seed + number) for number in range(VISITORS)]
        await asyncio.gather(*(visitor.run(count // VISITORS) for visitor in visitors))
        await asyncio.wait_for(open_page(app.address), ANSWER_SECONDS)
        return sum(visitor.sent for visitor in visitors)

    return run_on_new_loop(run)


def resting_memory(app: RunningApp) -> float:
    """Resident memory in bytes, without pages and running jobs."""
    wait_until(lambda: app.figure("sessions_open") + app.figure("jobs_in_flight") == 0, ANSWER_SECONDS)
    return app.figure("resident_memory_bytes")


def tracebacks(log: Path) -> list[str]:
    """Lines of tracebacks with their neighbours."""
    lines = log.read_text().splitlines()
    return ["\n".join(lines[max(n - 1, 0) : n + 60]) for n, line in enumerate(lines) if "Traceback" in line]


@pytest.mark.parametrize(
    "count", [pytest.param(4_000, marks=pytest.mark.slow), pytest.param(100_000, marks=pytest.mark.exhaustive)]
)
def test_many_random_messages_leave_no_memory_behind(count: int, served: tuple[RunningApp, Path]) -> None:
    app, output = served
    # The first half fills the caches.
    assert attack(app, count // 2, seed=100) == count // 2
    early = resting_memory(app)
    assert attack(app, count // 2, seed=200) == count // 2
    late = resting_memory(app)
    log.info("%d messages, resident memory from %.0f to %.0f MB", count, early / 2**20, late / 2**20)
    assert tracebacks(output) == []
    assert late < 1.3 * early
