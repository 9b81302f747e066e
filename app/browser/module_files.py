"""The files of the engine in the browser: its modules and the kernels.

The addresses contain a hash of everything on which the files depend, so browsers can keep the files.
"""

from __future__ import annotations

import gzip
import hashlib
from pathlib import Path
from typing import Any

from tornado.ioloop import IOLoop
from tornado.web import RequestHandler, StaticFileHandler

from engine.integrator.portable_kernels import module_digest
from plots.browser.compiled_files import browser_kernels

_ROOT = Path(__file__).parents[2]
# Folders of the modules: those that need the page, and those that do not.
_FOLDERS = "app/browser/modules", "plots/browser/modules"

NUMBERS_MODULE = _ROOT / "plots/browser/modules/numbers.js"
"""Module that writes numbers as text. Callbacks of Bokeh and components also use it."""


def _digest() -> str:
    """Return a hash of all modules and of the sources of the kernels."""
    digest = hashlib.sha256(module_digest().encode())
    for folder in _FOLDERS:
        for path in sorted((_ROOT / folder).rglob("*.js")):
            digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()[:16]


_FOLDER = f"browser/{_digest()}"
# The modules import each other by their places in the project.
_PAGE_FOLDER = f"{_FOLDER}/{_FOLDERS[0]}"

ADDRESS = f"{_PAGE_FOLDER}/main.js"
"""Address of the first module, relative to the page."""

WATCH_ADDRESS = f"{_PAGE_FOLDER}/gestures/watch.js"
"""Address of the module of the ensemble player, which the page loads when the player is first shown."""

LIVE_SECTION_ADDRESS = f"{_PAGE_FOLDER}/gestures/live_section.js"
"""Address of the module of the live section, which the page loads when the section is first shown."""

TOUR_ADDRESS = f"{_PAGE_FOLDER}/gestures/tour.js"
"""Address of the module of the tour, which the page loads when the tour begins."""

KERNELS_ADDRESS = f"{_FOLDER}/kernels.wasm"
"""Address of the kernels, relative to the page."""


def accepts_gzip(header: str) -> bool:
    """Whether the value of a header ``Accept-Encoding`` accepts gzip: with a weight above 0, by its name or by ``*``."""
    encodings = (encoding.replace(" ", "").lower().split(";q=") for encoding in header.split(","))
    weights = {name: weight[0] if weight else "1" for name, *weight in encodings}
    # A weight of 0, 0.0, 0.00 or 0.000 excludes an encoding.
    return weights.get("gzip", weights.get("*", "0")).strip("0.") != ""


class ModuleHandler(StaticFileHandler):
    """Serves a module, which browsers may keep."""

    def get_cache_time(self, path: str, modified: Any, mime_type: str) -> int:
        """Return ten years in seconds: the address changes with the content."""
        return self.CACHE_MAX_AGE


class KernelsHandler(RequestHandler):
    """Serves the kernels."""

    async def get(self) -> None:
        """Answer with the kernels, compressed if the browser accepts gzip."""
        module = await IOLoop.current().run_in_executor(None, browser_kernels)
        self.set_header("Content-Type", "application/wasm")
        self.set_header("Cache-Control", f"public, max-age={StaticFileHandler.CACHE_MAX_AGE}")
        self.set_header("Vary", "Accept-Encoding")
        if accepts_gzip(self.request.headers.get("Accept-Encoding", "")):
            self.set_header("Content-Encoding", "gzip")
            module = gzip.compress(module)
        self.finish(module)


ROUTES: tuple[tuple[str, type[RequestHandler], dict[str, Any]], ...] = (
    (rf"/{_FOLDER}/([a-z]+/browser/modules/(?:[a-z]+/)?[a-z_]+\.js)", ModuleHandler, {"path": str(_ROOT)}),
    (f"/{KERNELS_ADDRESS}", KernelsHandler, {}),
)
"""Paths below the server's prefix, with their handlers and the handlers' arguments."""
