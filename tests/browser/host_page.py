"""Serve pages of another origin that contain the page in a frame."""

from __future__ import annotations

import http.server
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from urllib.parse import unquote, urlsplit


class HostHandler(http.server.BaseHTTPRequestHandler):
    """Answers with a page that contains the code in the query string."""

    def do_GET(self) -> None:
        code = unquote(urlsplit(self.path).query)
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.end_headers()
        self.wfile.write(f"<!doctype html><h1>A talk</h1>{code}".encode())

    def log_message(self, format: str, *args: object) -> None:
        pass


@contextmanager
def host_server() -> Iterator[str]:
    """Yield the origin of a server of pages with frames. Chromium embeds no local page in a page that Playwright intercepts."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), HostHandler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
