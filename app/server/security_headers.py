"""What browsers are told not to do with the page: headers of every response.

Scripts come from this server, or stand in the page as it was served: those carry a number used once, so that nothing that is
slipped into the page later runs. Bokeh and Panel leave three gaps that cannot be closed from here: `unsafe-eval`, as both make
functions of text; `blob:`, from which Panel imports components; and `unsafe-inline` for styles, which Bokeh's views and MUI put
into the page as they run.
"""

from __future__ import annotations

import re
import secrets

from tornado.httputil import HTTPHeaders, HTTPServerRequest
from tornado.web import OutputTransform

from app.runtime.settings import current_settings

_SCRIPT = re.compile(rb"<script(?=[\s>])", re.IGNORECASE)


def mark_scripts(page: bytes, nonce: str) -> bytes:
    """A page whose scripts carry a nonce; the module loader of Panel passes it on to the scripts that it writes."""
    return _SCRIPT.sub(b'<script nonce="%b"' % nonce.encode(), page)


def content_policy(framers: tuple[str, ...], nonce: str | None = None) -> str:
    """The value of Content-Security-Policy.

    Parameters
    ----------
    framers
        Origins whose pages may show this one in a frame; empty for none.
    nonce
        What the scripts of the page carry; None for an answer that has none.
    """
    directives = {
        "default-src": ["'self'"],
        "script-src": ["'self'", "blob:", "'unsafe-eval'", *([f"'nonce-{nonce}'"] if nonce else [])],
        "style-src": ["'self'", "'unsafe-inline'"],
        "img-src": ["'self'", "data:", "blob:"],
        "font-src": ["'self'", "data:"],
        "connect-src": ["'self'", "blob:"],
        "object-src": ["'none'"],
        "base-uri": ["'self'"],
        "form-action": ["'self'"],
        "frame-ancestors": list(framers) or ["'none'"],
    }
    return "; ".join(f"{name} {' '.join(sources)}" for name, sources in directives.items())


def security_headers(framers: tuple[str, ...], nonce: str | None = None) -> dict[str, str]:
    """The headers of a response; parameters as those of `content_policy`."""
    headers = {
        "Content-Security-Policy": content_policy(framers, nonce),
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "strict-origin-when-cross-origin",
        "Permissions-Policy": "camera=(), geolocation=(), microphone=(), payment=(), usb=()",
    }
    # It knows no list of origins: where there is one, the policy alone speaks.
    return headers if framers else {**headers, "X-Frame-Options": "DENY"}


class SecurityTransform(OutputTransform):
    """Adds the headers to whatever Tornado sends, errors included."""

    def __init__(self, request: HTTPServerRequest) -> None:
        super().__init__(request)
        self._framers = current_settings().frame_ancestors

    def transform_first_chunk(
        self, status_code: int, headers: HTTPHeaders, chunk: bytes, finishing: bool
    ) -> tuple[int, HTTPHeaders, bytes]:
        """The same answer with more headers, and its scripts marked where it is a page."""
        nonce = None
        # Pages are short: one that comes in pieces is none of Bokeh's or ours.
        if finishing and chunk and headers.get("Content-Type", "").startswith("text/html"):
            nonce = secrets.token_urlsafe(16)
            chunk = mark_scripts(chunk, nonce)
            headers["Content-Length"] = str(len(chunk))
        for name, value in security_headers(self._framers, nonce).items():
            headers[name] = value
        # Which software answers, in which version, is nobody's business.
        headers.pop("Server", None)
        return status_code, headers, chunk
