"""Security headers of responses.

The Content-Security-Policy allows workers and scripts from this server, inline scripts with the nonce of the served page, and
WebAssembly (``wasm-unsafe-eval``) for the engine in the browser. Injected scripts lack the nonce, so they do not run.
Bokeh and Panel need three exceptions: ``unsafe-eval``, because both create functions from text; ``blob:``, from which Panel
imports components; and ``unsafe-inline`` for styles, which Bokeh inserts at run time.
"""

from __future__ import annotations

import re

from tornado.web import RequestHandler

from app.runtime.process_state import process_state

_SCRIPT_TAG = re.compile(r"<script(?=[\s>])", re.IGNORECASE)


class SecurityHeaders(RequestHandler):
    """Mixin that adds the headers to every response of a handler, including error pages."""

    def set_default_headers(self) -> None:
        """Set the headers and hide the name and version of the server software."""
        super().set_default_headers()
        self.set_security_headers()
        self.clear_header("Server")

    def set_security_headers(self, nonce: str | None = None) -> None:
        """Set the headers for a response whose inline scripts have this nonce."""
        for name, value in security_headers(process_state().settings.ancestors_at(self.request.host_name), nonce).items():
            self.set_header(name, value)


def add_nonce(page: str, nonce: str) -> str:
    """Return an HTML page with a nonce on all scripts. Panel's module loader passes the nonce on to scripts that it inserts."""
    return _SCRIPT_TAG.sub(f'<script nonce="{nonce}"', page)


def content_policy(frame_ancestors: tuple[str, ...], nonce: str | None = None) -> str:
    """Return the value of Content-Security-Policy.

    Parameters
    ----------
    frame_ancestors
        Origins that may embed the page in a frame; empty if no origin may.
    nonce
        Nonce of inline scripts; None to allow no inline scripts.
    """
    directives = {
        "default-src": ["'self'"],
        "script-src": ["'self'", "blob:", "'unsafe-eval'", "'wasm-unsafe-eval'", *([f"'nonce-{nonce}'"] if nonce else [])],
        "worker-src": ["'self'"],
        "style-src": ["'self'", "'unsafe-inline'"],
        "img-src": ["'self'", "data:", "blob:"],
        "font-src": ["'self'", "data:"],
        "connect-src": ["'self'", "blob:"],
        "object-src": ["'none'"],
        "base-uri": ["'self'"],
        "form-action": ["'self'"],
        "frame-ancestors": list(frame_ancestors) or ["'none'"],
    }
    return "; ".join(f"{name} {' '.join(sources)}" for name, sources in directives.items())


def security_headers(frame_ancestors: tuple[str, ...], nonce: str | None = None) -> dict[str, str]:
    """Return the headers of a response. The parameters are those of `content_policy`."""
    headers = {
        "Content-Security-Policy": content_policy(frame_ancestors, nonce),
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "strict-origin-when-cross-origin",
        "Permissions-Policy": "camera=(), geolocation=(), microphone=(), payment=(), usb=()",
    }
    # X-Frame-Options cannot list origins, so it is sent only if no origin may embed the page.
    return headers if frame_ancestors else {**headers, "X-Frame-Options": "DENY"}
