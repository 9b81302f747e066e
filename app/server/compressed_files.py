"""Static files, compressed for browsers that accept it: the scripts of Bokeh and Panel shrink to a quarter."""

from __future__ import annotations

import functools
import gzip
from pathlib import Path

from tornado.ioloop import IOLoop
from tornado.web import StaticFileHandler

# Other types of files are compressed already.
_SUFFIXES = frozenset({".js", ".mjs", ".css", ".svg", ".json", ".map"})
# Compressed, these files take some megabytes together.
_KEPT_FILES = 64


class CompressedFiles(StaticFileHandler):
    """Answers with a compressed file; a mixin for other handlers of static files."""

    async def get(self, path: str, include_body: bool = True) -> None:
        """Answer as the other handler does, but with a compressed file where possible."""
        accepts = "gzip" in self.request.headers.get("Accept-Encoding", "") and "Range" not in self.request.headers
        if not accepts or Path(path).suffix not in _SUFFIXES:
            await super().get(path, include_body)
            return
        self.path = self.parse_url_path(path)
        absolute_path = self.validate_absolute_path(self.root, self.get_absolute_path(self.root, self.path))
        if absolute_path is None:
            return
        self.absolute_path = absolute_path
        self.modified = self.get_modified_time()
        self.set_headers()
        self.set_header("Vary", "Accept-Encoding")
        if self.should_return_304():
            self.set_status(304)
            return
        changed = Path(absolute_path).stat().st_mtime_ns
        # A new version is compressed once, which takes up to 0.1 s.
        content = await IOLoop.current().run_in_executor(None, _compressed, absolute_path, changed)
        self.set_header("Content-Encoding", "gzip")
        self.set_header("Content-Length", len(content))
        if include_body:
            self.write(content)


@functools.lru_cache(maxsize=_KEPT_FILES)
def _compressed(path: str, _changed: int) -> bytes:
    """Return a file, compressed; `_changed` is the time of its last change."""
    return gzip.compress(Path(path).read_bytes())
