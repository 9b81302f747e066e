"""Make random HTTP requests for the routes of a server, usual ones and ones that no browser sends."""

from __future__ import annotations

import base64
import json
import random
import zlib
from collections.abc import Sequence

METHODS = (b"GET",) * 12 + (b"HEAD", b"POST", b"OPTIONS", b"PUT", b"DELETE", b"PATCH", b"CONNECT", b"get", b"", b"G\x00T")
VERSIONS = (b"HTTP/1.1",) * 12 + (b"HTTP/1.0", b"HTTP/2.0", b"HTTP/9", b"", b"x")
PIECES = (
    "unittest.__main__", "cli.__main__", "panel.widgets", "x", "_css", "_resources", "..", "%2e%2e", "%00", "%ff", "//",
    "\\", "a" * 300, "a" * 9000, "é", "%", "%u2028", "js/bokeh.min.js", "panel/panel.min.js", "theme.css",
    "gallery/owl.png", ".", "~", "*", "[", "(.*)", "con", "?", "#", ";", "%0d%0aX:%20y", "etc/passwd",
)  # fmt: skip
NAMES = (
    "case", "V", "h", "plane", "resolution", "t_max", "orbits", "window", "look", "theme", "bytes", "bokeh-token",
    "bokeh-session-id", "bokeh-absolute-url", "bokeh-autoload-element", "bokeh-app-path", "v", "", "editable", "reset",
)  # fmt: skip
VALUES = (
    "I", "III", "typed", "0.2", "nan", "1e999", "48", "100", "x_px", "x^2/2+y^2/2-x^3", "%ff", "%00", "", "[]", "{", "<b>",
    "9" * 500, "0;" * 3000, "%f0%9f", "//elsewhere.example", "../..", "0.1,0.1;0.2,0.2",
)  # fmt: skip
HEADERS = (
    "Host: elsewhere.example", "Host:", "Host: a\\b", "Cookie: a=b; c", "Cookie: \xff=\"", "Range: bytes=0-10",
    "Range: bytes=9-1", "Range: bytes=-1,5", "Range: x", "If-None-Match: *", "If-Modified-Since: x", "Bokeh-Session-Id: x",
    "Origin: null", "Origin: x:y:z", "Origin: http://[::1", "Content-Length: 5", "Content-Length: -1",
    "Content-Length: 99999999999", "Transfer-Encoding: chunked", "Content-Type: multipart/form-data; boundary=x",
    "Content-Type: application/x-www-form-urlencoded", "X-Forwarded-For: x", " folded", "no colon", "Upgrade: h2c",
    "Expect: 100-continue", "Accept-Encoding: gzip", "User-Agent: " + "x" * 5000, "X: " + "x" * 20_000,
    "Accept-Language: \xe9", "X-Scheme: ftp",
)  # fmt: skip
UPGRADE = (
    "Connection: Upgrade",
    "Upgrade: websocket",
    "Sec-WebSocket-Version: 13",
    "Sec-WebSocket-Key: eHh4eHh4eHh4eHh4eHh4eA==",
)
BODIES = (
    b"",
    b"",
    b"x",
    b"a=b&c",
    b"--x\r\n\r\n--x--",
    b"5\r\nhello\r\n0\r\n\r\n",
    b"zz\r\n",
    b"\x81\x85abcdhello",
    b"\xff" * 500,
)


class RandomRequests:
    """Makes random requests.

    Parameters
    ----------
    routes
        Patterns of paths.
    seed
        Seed of the random numbers.
    """

    def __init__(self, routes: Sequence[str], seed: int) -> None:
        self._routes, self._random = routes, random.Random(seed)

    def make(self) -> bytes:
        """Return a request, complete or not."""
        if self._random.random() < 0.02:
            return self._random.randbytes(self._random.randrange(200))
        path = self._path()
        lines = [b" ".join([self._random.choice(METHODS), path, self._random.choice(VERSIONS)])]
        headers = ["Host: localhost", *self._some(HEADERS, 0.4)]
        if path.endswith(b"/ws") or self._random.random() < 0.02:
            headers += [*(line for line in UPGRADE if self._random.random() < 0.98), f"Sec-WebSocket-Protocol: {self._offer()}"]
        lines += [header.encode("latin-1") for header in headers]
        return b"\r\n".join([*lines, b"", self._random.choice(BODIES)])

    def _some(self, choices: Sequence[str], probability: float) -> list[str]:
        """Return a random number of choices. After each choice, there is another one with `probability`."""
        chosen = []
        while self._random.random() < probability:
            chosen.append(self._random.choice(choices))
        return chosen

    def _path(self) -> bytes:
        path = self._random.choice(self._routes)
        path = path.replace("/?", self._random.choice(("", "", "/")))
        path = path.replace("(.*)", "/".join(self._some(PIECES, 0.7))) or "/"
        if self._random.random() < 0.05:
            path += "/".join(["", *self._some(PIECES, 0.5)])
        pairs = [f"{self._random.choice(NAMES)}={self._random.choice(VALUES)}" for _ in self._some(NAMES, 0.5)]
        if pairs and path == "/app":
            # A map that takes little time.
            pairs.append("resolution=48&t_max=100")
        return (path + ("?" + "&".join(pairs) if pairs else "")).encode()

    def _offer(self) -> str:
        """Return the subprotocols of a WebSocket: with a token that the server has not issued, or without a token."""
        payload = {"session_id": self._random.choice(("", "x" * 44, 5)), "session_expiry": self._random.choice((0, 2**40, "x"))}
        bomb = zlib.compress(b"0" * self._random.choice((0, 2**12, 2**22)), 9)
        token = base64.urlsafe_b64encode(json.dumps({**payload, "__bk__zlib_": base64.urlsafe_b64encode(bomb).decode()}).encode())
        name = self._random.choice(("bokeh", "bokeh", "bokeh", "x", ""))
        return ", ".join([name, token.decode().rstrip("="), *self._some(("x", "\xe9"), 0.1)])
