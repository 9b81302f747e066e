"""First start of the server with an empty kernel cache, and a second start: seconds until the first map of the page.

A simulated session opens the page as soon as the server answers, and waits for the map of the default view. In brackets the
processor time of the server until then, which depends less on what else the machine does.

Run: uv run python -m benchmarks.first_start
"""

from __future__ import annotations

import argparse
import asyncio
import json
import statistics
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from tornado.httpclient import AsyncHTTPClient

from benchmarks.load import START_SECONDS, Server, started, wait_until_ready
from tests.page_channel import Channel

POLL_SECONDS = 0.05
EVENTS = ("the server answers", "the page is open", "first pixels of the map", "the map is complete", "all kernels are compiled")


async def open_when_possible(address: str) -> str:
    """The page, as soon as the server answers."""
    deadline = time.monotonic() + START_SECONDS
    while True:
        try:
            return (await AsyncHTTPClient().fetch(address, request_timeout=START_SECONDS)).body.decode()
        except ConnectionRefusedError:
            if time.monotonic() > deadline:
                raise
            await asyncio.sleep(POLL_SECONDS)


Moment = tuple[float, float]
"""Time and processor time since the start of the process, in seconds."""


async def watch_first_map(server: Server, moment: Callable[[], Moment]) -> list[Moment]:
    """Moments of the first four of `EVENTS`."""
    page = await open_when_possible(server.address)
    moments = [moment()]
    channel = await Channel.connect(server.address, page)
    async for kind, content in channel.messages():
        if kind == "ACK":
            channel.send("PULL-DOC-REQ", {})
        elif kind == "PULL-DOC-REPLY":
            channel.emit("document_ready")
            moments.append(moment())
        elif kind == "PATCH-DOC":
            for columns in map_updates(content):
                if len(moments) == 2:
                    moments.append(moment())
                if columns["complete"] == [True]:
                    channel.close()
                    return [*moments, moment()]
    raise RuntimeError("the server closed the socket before the map was complete")


def map_updates(content: str) -> list[dict[str, Any]]:
    """The columns of all maps in a message."""
    changes = [event.get("new", event.get("data")) for event in json.loads(content)["events"] if event.get("attr") == "data"]
    columns = [dict(change["entries"]) for change in changes]
    return [each for each in columns if "complete" in each]


def time_start(folder: Path) -> list[Moment]:
    """Moments of `EVENTS`; the kernel cache in the folder is filled by its first start."""
    begin = time.perf_counter()
    with started(folder / "log") as (server, process):

        def moment() -> Moment:
            return time.perf_counter() - begin, server.cpu_seconds()

        moments = asyncio.run(watch_first_map(server, moment))
        wait_until_ready(server, process)
        return [*moments, moment()]


def median(moments: Iterable[Moment]) -> str:
    """Medians of both times."""
    elapsed, used = (statistics.median(times) for times in zip(*moments, strict=True))
    return f"{elapsed:.1f} ({used:.1f})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3)
    repeats = parser.parse_args().repeats
    first, second = [], []
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as folder:
            first.append(time_start(Path(folder)))
            second.append(time_start(Path(folder)))
    print(f"Seconds from the start of the process, medians of {repeats}:\n")
    print("| until | empty kernel cache | filled kernel cache |\n|---|---|---|")
    for row, event in enumerate(EVENTS):
        columns = (median(moments[row] for moments in runs) for runs in (first, second))
        print(f"| {event} | {' | '.join(columns)} |")


if __name__ == "__main__":
    main()
