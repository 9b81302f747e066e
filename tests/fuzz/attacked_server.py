"""Open pages of a server for random input, which has small caches, and check its memory and log."""

from __future__ import annotations

from pathlib import Path

from tornado.httpclient import AsyncHTTPClient

from tests.browser.served_app import RunningApp
from tests.page_channel import Channel
from tests.waiting import SECONDS, wait_until

LINK = "?case=I&h=0.3&resolution=48&t_max=100"
"""Link to a map that takes little time."""

SETTINGS = {"CACHE_BYTES": str(32 * 2**20), "PAGES_PER_ADDRESS": "10", "COMPILED_OPERATIONS": "50000"}


async def fetch_page(address: str) -> str:
    """Return the page of a map that takes little time."""
    page = await AsyncHTTPClient().fetch(address + LINK, request_timeout=SECONDS)
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


def resting_memory(app: RunningApp) -> float:
    """Return the resident memory in bytes, when there are no pages and no running jobs."""
    wait_until(lambda: app.figure("sessions_open") + app.figure("jobs_in_flight") == 0, SECONDS)
    return app.figure("resident_memory_bytes")


def tracebacks(log: Path) -> list[str]:
    """Return the tracebacks of a log with the lines around them."""
    lines = log.read_text().splitlines()
    return ["\n".join(lines[max(n - 1, 0) : n + 60]) for n, line in enumerate(lines) if "Traceback" in line]
