"""Random requests to all mounted routes: the server stays alive, small and fast, with no traceback in its log."""

from __future__ import annotations

import asyncio
import logging
from pathlib import Path

import pytest

from tests.app.other_loop import run_on_new_loop
from tests.app.server.mounted_routes import mounted_routes
from tests.browser.served_app import RunningApp
from tests.fuzz.attacked_server import ANSWER_SECONDS, open_page, resting_memory, tracebacks
from tests.fuzz.random_requests import RandomRequests

log = logging.getLogger(__name__)

CLIENTS = 8
LARGEST_GROWTH = 0.15


async def send(port: int, request: bytes) -> bytes:
    """Return the first line of the answer; empty if the server closes the connection."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        writer.write(request)
        # Otherwise the server waits for the rest of an incomplete request.
        writer.write_eof()
        first = (await asyncio.wait_for(reader.read(), ANSWER_SECONDS)).partition(b"\r\n")[0]
        await asyncio.wait_for(writer.drain(), ANSWER_SECONDS)
    except ConnectionError:
        return b""
    finally:
        writer.close()
    return first


def attack(app: RunningApp, requests: RandomRequests, count: int) -> dict[bytes, int]:
    """Send requests, some at a time; how often each status was answered."""
    port, answers = int(app.root.rpartition(":")[2]), dict[bytes, int]()

    async def client() -> None:
        for _ in range(count // CLIENTS):
            status = (await send(port, requests.make()))[9:12]
            answers[status] = answers.get(status, 0) + 1

    async def run() -> None:
        await asyncio.gather(*(client() for _ in range(CLIENTS)))

    run_on_new_loop(run)
    return answers


@pytest.mark.slow
def test_random_requests_leave_no_memory_behind(served: tuple[RunningApp, Path]) -> None:
    app, output = served
    requests = RandomRequests(mounted_routes()[1:], seed=7)
    answers = attack(app, requests, 5000)
    early = resting_memory(app)
    later = attack(app, requests, 5000)
    late = resting_memory(app)
    run_on_new_loop(lambda: asyncio.wait_for(open_page(app.address), ANSWER_SECONDS))
    log.info("%s, %s, resident memory from %.0f to %.0f MB", answers, later, early / 2**20, late / 2**20)
    assert app.process.poll() is None
    assert tracebacks(output) == []
    assert {status for status in {*answers, *later} if status.startswith(b"5")} <= {b"503", b"505"}
    assert late < (1.0 + LARGEST_GROWTH) * early
