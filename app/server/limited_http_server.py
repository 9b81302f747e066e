"""Tornado's HTTP server with limits, and with the routes of this server only.

`Configurable.configure` of Tornado replaces the class of all HTTP servers of the process. No other public interface gives access
to the web application and to the options of the HTTP server of ``panel serve``.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Awaitable, Mapping
from typing import Any

from bokeh.server.tornado import BokehTornado
from tornado.httpserver import HTTPServer
from tornado.httputil import HTTPConnection, HTTPHeaders, HTTPMessageDelegate, RequestStartLine, ResponseStartLine
from tornado.iostream import IOStream, StreamClosedError, UnsatisfiableReadError

from app.runtime.process_state import process_state
from app.runtime.visitors import network_of
from app.server.admission import LONGEST_LINK, RETRY_SECONDS, refusal_page
from app.server.batched_stream import batched
from app.server.routes import redirect_to_page, refuse_other_hosts, refuse_other_routes, secure_other_files
from app.server.security_headers import security_headers

LIMITS: Mapping[str, int] = {
    # Longest time until the next request of a connection has begun and its headers have arrived.
    "idle_connection_timeout": 20,
    "body_timeout": 10,
    # The page uploads nothing.
    "max_body_size": 64 * 1024,
    # The request of a WebSocket contains cookies, the link, and a token that can be longer than the link. `deploy/nginx.conf`
    # passes headers of up to 65 kB.
    "max_header_size": 10 * LONGEST_LINK,
}
"""Options of the HTTP server, in seconds and bytes."""

UNTRUSTED_HEADERS = ("X-Real-Ip", "X-Scheme")
"""Headers that are removed from requests, because a client can forge them. With ``--use-xheaders``, Tornado prefers them to
``X-Forwarded-For`` and ``X-Forwarded-Proto``, which the proxy sets."""

CONNECTIONS_PER_PAGE = 6
"""Largest number of connections, WebSockets apart, that a browser opens to a host."""


MOST_REFUSALS = 200
"""Largest number of connections beyond the limits that are answered at the same time. Others are closed without an answer."""

# Longest time until a request has arrived and its refusal has been sent, in seconds.
_REFUSAL_SECONDS = 2.0
_REFUSAL = "There are too many connections."


class LimitedHTTPServer(HTTPServer):
    """HTTP server that answers connections beyond the limits with 503, and refuses routes and hosts that are not its own.

    `app.server.admission` counts WebSockets. Behind a proxy (``--use-xheaders``) all connections come from one address, so only
    their total number is limited.
    """

    def initialize(self, *args: Any, **kwargs: Any) -> None:
        """Apply the limits. Tornado calls this instead of a constructor."""
        super().initialize(*args, **{**LIMITS, **kwargs})
        # Numbers of open connections, WebSockets apart, by network.
        self._connection_counts: Counter[str] = Counter()
        self._refusals: set[asyncio.Task[None]] = set()
        if isinstance(self.request_callback, BokehTornado):
            refuse_other_routes(self.request_callback)
            refuse_other_hosts(self.request_callback)
            redirect_to_page(self.request_callback)
            secure_other_files(self.request_callback)

    def handle_stream(self, stream: IOStream, address: Any) -> None:
        """Serve a new connection, or refuse it."""
        network = _network(address)
        if self._is_full(network):
            process_state().metrics.connections_refused.inc()
            self._refuse(stream)
            return
        self._connection_counts[network] += 1
        super().handle_stream(batched(stream), address)

    def start_request(self, server_conn: object, request_conn: HTTPConnection) -> HTTPMessageDelegate:
        """Read a request without the headers in `UNTRUSTED_HEADERS`."""
        return _UntrustedHeaderRemover(super().start_request(server_conn, request_conn))

    def on_close(self, server_conn: Any) -> None:
        """Stop counting a connection that is closed or has become a WebSocket."""
        super().on_close(server_conn)
        # Unlike the method `subtract`, this operator removes counts of 0.
        self._connection_counts -= Counter([_network(server_conn.context.address)])

    def _refuse(self, stream: IOStream) -> None:
        """Answer a request if there are not too many refusals, and close the connection."""
        if len(self._refusals) >= MOST_REFUSALS:
            stream.close()
            return
        refusal = asyncio.ensure_future(_answer_refused(stream))
        self._refusals.add(refusal)
        refusal.add_done_callback(self._refusals.discard)

    def _is_full(self, network: str) -> bool:
        """Whether the server, or a network unless a proxy hides it, has all the connections that it may have."""
        settings = process_state().settings
        if self._connection_counts.total() >= settings.most_connections:
            return True
        return not self.xheaders and self._connection_counts[network] >= CONNECTIONS_PER_PAGE * settings.pages_per_address


async def _answer_refused(stream: IOStream) -> None:
    """Answer a request with status 503 and close the connection. A proxy would take a missing answer as a fault of the server."""
    body = refusal_page(_REFUSAL).encode()
    headers = HTTPHeaders({"Content-Type": "text/html; charset=utf-8", "Content-Length": str(len(body)), "Connection": "close"})
    headers.update({"Retry-After": str(RETRY_SECONDS)} | security_headers(process_state().settings.frame_ancestors))
    lines = "".join(f"{name}: {value}\r\n" for name, value in headers.get_all())
    try:
        async with asyncio.timeout(_REFUSAL_SECONDS):
            # If bytes of the request were left unread, closing the connection could discard the answer.
            await stream.read_until(b"\r\n\r\n", max_bytes=LIMITS["max_header_size"])
            await stream.write(f"HTTP/1.1 503 Service Unavailable\r\n{lines}\r\n".encode() + body)
    except (TimeoutError, StreamClosedError, UnsatisfiableReadError):
        pass
    finally:
        stream.close()


class _UntrustedHeaderRemover(HTTPMessageDelegate):
    """Removes the headers in `UNTRUSTED_HEADERS` before another delegate receives a request."""

    def __init__(self, delegate: HTTPMessageDelegate) -> None:
        self._delegate = delegate

    def headers_received(self, start_line: RequestStartLine | ResponseStartLine, headers: HTTPHeaders) -> Awaitable[None] | None:
        for name in UNTRUSTED_HEADERS:
            headers.pop(name, None)
        return self._delegate.headers_received(start_line, headers)

    def data_received(self, chunk: bytes) -> Awaitable[None] | None:
        return self._delegate.data_received(chunk)

    def finish(self) -> None:
        self._delegate.finish()

    def on_connection_close(self) -> None:
        self._delegate.on_connection_close()


def _network(peer: Any) -> str:
    """Return the network of the peer of a connection; empty for a Unix socket, whose peer has no address."""
    return network_of(peer[0]) if peer else ""
