"""The hooks of Bokeh's server install the handlers of the page."""

from __future__ import annotations

from pathlib import Path

from bokeh.server import urls

from app import app_hooks
from app.server.endpoints import ROUTES
from app.server.routes import PageHandler, PageWebSocket, install_handlers
from app.server.security_headers import SecurityHeaders

ROOT = Path(__file__).parents[2]


def test_handlers_are_installed_once() -> None:
    assert app_hooks.process_request
    before = [*urls.per_app_patterns], [*urls.toplevel_patterns]
    assert {handler for _, handler, *_ in before[0]} >= {PageHandler, PageWebSocket}
    assert set(ROUTES) <= {pattern for pattern in before[1] if len(pattern) == 2}
    install_handlers(urls.per_app_patterns, urls.toplevel_patterns)
    assert (urls.per_app_patterns, urls.toplevel_patterns) == before


def test_all_handlers_but_the_redirect_have_security_headers() -> None:
    patterns = [*urls.per_app_patterns, *urls.toplevel_patterns]
    assert [path for path, handler, *_ in patterns if not issubclass(handler, SecurityHeaders)] == ["/?"]
