"""What Bokeh's server finds in the hooks."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from bokeh.server import urls

from app import app_hooks
from app.server.endpoints import ROUTES, add_routes

ROOT = Path(__file__).parents[2]


def test_the_pages_are_on_every_server_once_however_often_the_hooks_are_run() -> None:
    assert app_hooks.process_request
    before = list(urls.toplevel_patterns)
    assert set(ROUTES) <= {pattern for pattern in before if len(pattern) == 2}
    add_routes(urls.toplevel_patterns)
    assert urls.toplevel_patterns == before


def test_a_setting_that_is_none_stops_the_server_before_it_starts() -> None:
    environment = {**os.environ, "ESCAPE_EXPLORER_THREADS": "0"}
    command = [sys.executable, "-m", "panel", "serve", "app", "--port", "0"]
    ended = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=240, check=False)
    assert ended.returncode == 2
    assert ended.stderr.splitlines()[-1] == "ESCAPE_EXPLORER_THREADS='0': must be a whole number from 1 to 1024"
