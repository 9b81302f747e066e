"""The hooks of Bokeh's server."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from bokeh.server import urls

from app import app_hooks
from app.server.endpoints import ROUTES
from app.server.security_headers import SecurityHeaders
from app.server.url_patterns import PageHandler, PageWebSocket, install_handlers

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


def test_invalid_setting_ends_the_server_with_one_sentence() -> None:
    environment = {**os.environ, "ESCAPE_EXPLORER_THREADS": "0"}
    command = [sys.executable, "-m", "panel", "serve", "app", "--port", "0"]
    ended = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=240, check=False)
    assert ended.returncode == 2
    assert ended.stderr.splitlines()[-1] == "ESCAPE_EXPLORER_THREADS='0': must be a whole number from 1 to 1024"
