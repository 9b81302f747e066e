"""The modules of the engine in the browser as files; their address contains a hash of all of them, so that browsers keep them."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

from tornado.web import StaticFileHandler

MODULES = Path(__file__).parent / "modules"


def _digest() -> str:
    """A hash of all modules."""
    digest = hashlib.sha256()
    for path in sorted(MODULES.glob("*.js")):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()[:16]


_FOLDER = f"browser/{_digest()}"

ADDRESS = f"{_FOLDER}/main.js"
"""Address of the first module, relative to the page."""


WATCH_ADDRESS = f"{_FOLDER}/watch.js"
"""Address of the player of many orbits, which the page loads when it is asked for."""


class ModuleHandler(StaticFileHandler):
    """Serves a module."""

    def get_cache_time(self, path: str, modified: Any, mime_type: str) -> int:
        """Return ten years, because the address changes with the content."""
        return self.CACHE_MAX_AGE


ROUTE = (rf"/{_FOLDER}/([a-z_]+\.js)", ModuleHandler, {"path": str(MODULES)})
"""Path, handler and arguments."""
