"""Data written in one iteration of the event loop are sent together, in order."""

from __future__ import annotations

import asyncio
import socket
import ssl
from collections.abc import Awaitable, Callable
from typing import Any
from unittest.mock import patch

import pytest
from tornado.iostream import IOStream, SSLIOStream, StreamClosedError

from app.server.batched_stream import batched
from tests.app.other_loop import run_on_new_loop
from tests.waiting import SECONDS

PARTS = [b"first ", b"second ", b"third ", b"fourth"]

Scenario = Callable[[IOStream, IOStream], Awaitable[None]]


def run(scenario: Scenario) -> None:
    """Run a scenario with the batched stream of the server and the stream of its peer."""

    async def with_streams() -> None:
        ours, theirs = socket.socketpair()
        stream, peer = batched(IOStream(ours)), IOStream(theirs)
        try:
            async with asyncio.timeout(SECONDS):
                await scenario(stream, peer)
        finally:
            stream.close()
            peer.close()

    run_on_new_loop(with_streams)


def test_all_parts_arrive_in_order_with_two_system_calls() -> None:
    async def scenario(stream: IOStream, peer: IOStream) -> None:
        with patch.object(IOStream, "write_to_fd", autospec=True, side_effect=IOStream.write_to_fd) as write_to_fd:
            await asyncio.gather(*[stream.write(part) for part in PARTS])
            assert await peer.read_bytes(len(b"".join(PARTS))) == b"".join(PARTS)
        assert write_to_fd.call_count == 2

    run(scenario)


def test_the_first_part_of_an_iteration_is_sent_at_once() -> None:
    async def scenario(stream: IOStream, peer: IOStream) -> None:
        for part in PARTS:
            assert stream.write(part).done()
            assert await peer.read_bytes(len(part)) == part
            # Another iteration begins.
            await asyncio.sleep(0.0)

    run(scenario)


def test_closing_sends_what_has_been_written() -> None:
    async def scenario(stream: IOStream, peer: IOStream) -> None:
        results = [stream.write(part) for part in PARTS]
        stream.close()
        assert await peer.read_until_close() == b"".join(PARTS)
        await asyncio.gather(*results)
        with pytest.raises(StreamClosedError):
            stream.write(b"late")

    run(scenario)


def test_a_connection_whose_client_does_not_read_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    async def scenario(stream: IOStream, peer: IOStream) -> None:
        with pytest.raises(StreamClosedError):
            await stream.write(bytes(10_000_000))

    monkeypatch.setattr("app.server.batched_stream.LONGEST_WRITE", 0.1)
    run(scenario)


def test_the_limit_of_a_write_ends_when_its_data_are_sent() -> None:
    async def scenario(stream: IOStream, peer: IOStream) -> None:
        loop, limits = asyncio.get_running_loop(), []

        def call_later(delay: float, *arguments: Any) -> asyncio.TimerHandle:
            limits.append(loop.call_at(loop.time() + delay, *arguments))
            return limits[-1]

        with patch.object(loop, "call_later", call_later):
            sent = stream.write(bytes(10_000_000))
        assert [limit.cancelled() for limit in limits] == [False]
        await peer.read_bytes(10_000_000)
        await sent
        assert [limit.cancelled() for limit in limits] == [True]

    run(scenario)


def test_a_stream_with_encryption_stays_as_it_is() -> None:
    async def check() -> None:
        ours, theirs = socket.socketpair()
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        stream = SSLIOStream(context.wrap_socket(ours, server_side=True, do_handshake_on_connect=False))
        try:
            assert batched(stream) is stream
        finally:
            stream.close()
            theirs.close()

    run_on_new_loop(check)


def test_one_cancelled_write_does_not_concern_the_others() -> None:
    async def scenario(stream: IOStream, peer: IOStream) -> None:
        _, second, third, fourth = [stream.write(part) for part in PARTS]
        third.cancel()
        await asyncio.gather(second, fourth)
        assert await peer.read_bytes(len(b"".join(PARTS))) == b"".join(PARTS)

    run(scenario)
