"""What a client can send to make a server fail. Each client opens a connection, sends, and returns the sockets that stay open."""

from __future__ import annotations

import itertools
import socket
import ssl
from collections.abc import Callable, Iterable, Mapping

from tests.deploy.proxy import ADDRESS_HEADER, Proxy, authorization

_ADDRESS = b"192.0.2.66"
# Each connection has an address of its own, or nginx would refuse it.
_numbers = itertools.count()

Client = Callable[[Proxy], list[ssl.SSLSocket]]


def connect(proxy: Proxy) -> ssl.SSLSocket:
    plain = socket.create_connection(("127.0.0.1", proxy.port))
    return proxy.ssl_context().wrap_socket(plain, server_hostname="127.0.0.1")


def request(path: str, *lines: str, method: str = "GET") -> bytes:
    """Return a request whose headers do not end."""
    headers = authorization() | {"Host": "127.0.0.1", ADDRESS_HEADER: _ADDRESS.decode()}
    named = [f"{name}: {value}" for name, value in headers.items()]
    return "\r\n".join([f"{method} {path} HTTP/1.1", *named, *lines, ""]).encode()


def _send(connection: ssl.SSLSocket, parts: Iterable[bytes]) -> None:
    number = next(_numbers)
    for part in parts:
        connection.sendall(part.replace(_ADDRESS, f"192.0.{number // 250}.{number % 250}".encode()))


def _sending(*parts: bytes, is_read: bool = True) -> Client:
    """Return a client that sends parts on one connection, and waits for the beginning of an answer."""

    def client(proxy: Proxy) -> list[ssl.SSLSocket]:
        connection = connect(proxy)
        _send(connection, parts)
        if is_read:
            connection.recv(65536)
        return [connection]

    return client


def _leaving(*parts: bytes) -> Client:
    """Return a client that sends parts on one connection, and closes the connection at once."""

    def client(proxy: Proxy) -> list[ssl.SSLSocket]:
        with connect(proxy) as connection:
            _send(connection, parts)
        return []

    return client


_LARGE = [f"X-Large-{k}: {'x' * 12_000}" for k in range(3)]
_MANY = [f"X-{k}: {'x' * 500}" for k in range(100)]

CLIENTS: Mapping[str, Client] = {
    "large headers": _sending(request("/app", *_LARGE) + b"\r\n"),
    "headers longer than nginx accepts": _sending(request("/app", *_LARGE, *_LARGE) + b"\r\n"),
    "many headers": _sending(request("/app", *_MANY) + b"\r\n"),
    "a long address": _sending(request("/app?V=" + "x" * 15_000) + b"\r\n"),
    "slow headers": _sending(request("/app"), is_read=False),
    "half a request": _leaving(request("/app")),
    "a slow body": _sending(request("/app", "Content-Length: 1000", method="POST") + b"\r\n0123456789", is_read=False),
    "a body with wrong chunks": _sending(request("/app", "Transfer-Encoding: chunked", method="POST") + b"\r\nno length\r\n"),
    "a page that waits": _leaving(request("/app?wait") + b"\r\n"),
    "a closed connection": _leaving(request("/app") + b"\r\n"),
    "an upgrade to nothing": _sending(request("/app/ws", "Connection: Upgrade", "Upgrade: nothing") + b"\r\n"),
    "a WebSocket without a key": _sending(request("/app/ws", "Connection: Upgrade", "Upgrade: websocket") + b"\r\n"),
    "a header that is not legal": _sending(request("/app", "X: \x00") + b"\r\n"),
    "no request": _sending(b"\x16\x03\r\n\r\n"),
}
"""Clients by what they send."""
