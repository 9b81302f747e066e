"""Connections that send what is written in one iteration of the event loop with few system calls."""

from __future__ import annotations

import asyncio
import socket
from asyncio import Future
from contextlib import suppress
from typing import Any

from tornado.concurrent import chain_future
from tornado.iostream import IOStream, UnsatisfiableReadError

LONGEST_WRITE = 120.0
"""Longest time until written data are sent, in seconds. A client that reads too slowly would otherwise keep its connection, and
the data that wait for it, without end."""

_HEADERS_TOO_LARGE = b"HTTP/1.1 431 Request Header Fields Too Large\r\nConnection: close\r\nContent-Length: 0\r\n\r\n"
# Number of reads that empty the connection after this answer.
_MOST_READS = 16


class BatchedStream(IOStream):
    """A connection that sends the first data of an iteration of the event loop at once, and all further data after it.

    A Bokeh message consists of a dozen WebSocket messages or more, and Tornado makes a system call for each. During each call
    another thread can take the interpreter lock, and the event loop then waits for it, up to a millisecond
    (`sys.setswitchinterval`). The first data are sent at once, because Tornado expects this of the answer that opens a WebSocket.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        # Whether data have been sent in this iteration.
        self._has_sent = False
        # Data that wait for the end of the iteration, and the result of each write.
        self._parts: list[bytes | memoryview] = []
        self._results: list[Future[None]] = []

    def write(self, data: bytes | memoryview) -> Future[None]:
        """Send data; see `IOStream.write`."""
        if self.closed():
            # This raises StreamClosedError.
            return super().write(data)
        if not self._has_sent:
            self._has_sent = True
            asyncio.get_running_loop().call_soon(self._end_batch)
            return self._write(data)
        result: Future[None] = Future()
        # The caller need not await the result.
        result.add_done_callback(lambda done: done.cancelled() or done.exception())
        self._parts.append(data)
        self._results.append(result)
        return result

    def close(self, exc_info: Any = False) -> None:
        """Send what is written, and close the connection; see `IOStream.close`.

        Tornado closes a connection without an answer if its headers are too long. They are answered here, because a proxy would
        take the end of the connection for a failure of the server.
        """
        if isinstance(exc_info, UnsatisfiableReadError):
            self._refuse_headers()
        self._end_batch()
        super().close(exc_info)

    def _write(self, data: bytes | memoryview) -> Future[None]:
        """Send data, and close the connection if this takes too long."""
        sent = super().write(data)
        if not sent.done():
            limit = asyncio.get_running_loop().call_later(LONGEST_WRITE, self.close)
            sent.add_done_callback(lambda _: limit.cancel())
        return sent

    def _refuse_headers(self) -> None:
        with suppress(OSError):
            self.socket.send(_HEADERS_TOO_LARGE)
            self.socket.shutdown(socket.SHUT_WR)
            # If data were left unread, the system would discard the answer.
            for _ in range(_MOST_READS):
                self.socket.recv(self.read_chunk_size)

    def _end_batch(self) -> None:
        """Send the data that were written after the first data of the iteration."""
        self._has_sent = False
        parts, self._parts = self._parts, []
        results, self._results = self._results, []
        if parts:
            # The stream is open, because `close` ends the batch first.
            sent = self._write(b"".join(parts))
            for result in results:
                chain_future(sent, result)


def batched(stream: IOStream) -> IOStream:
    """Return a stream of the same socket that sends in batches. A stream with encryption is returned as it is.

    Parameters
    ----------
    stream
        A new stream, of which nothing has been read.
    """
    if type(stream) is not IOStream:
        return stream
    return BatchedStream(stream.socket, max_buffer_size=stream.max_buffer_size, read_chunk_size=stream.read_chunk_size)
