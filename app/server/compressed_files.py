"""Static files, compressed for browsers that accept gzip: the scripts of Bokeh and Panel shrink to a quarter."""

from __future__ import annotations

import functools
import gzip
from pathlib import Path

from tornado.ioloop import IOLoop
from tornado.web import StaticFileHandler

# Suffixes of the files to compress. Other types are compressed already.
_SUFFIXES = frozenset({".js", ".mjs", ".css", ".svg", ".json", ".map"})
# Number of compressed files that are kept; together they take some megabytes.
_KEPT_FILES = 64


class CompressedFiles(StaticFileHandler):
    """Mixin for handlers of static files, which answers with a compressed file."""

    async def get(self, path: str, include_body: bool = True) -> None:
        """Answer with a compressed file if the browser accepts it and the type is worth it, otherwise as the other handler."""
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
        # Compressing takes up to 0.1 s, once for each version of a file.
        content = await IOLoop.current().run_in_executor(None, _compressed, absolute_path, changed)
        self.set_header("Content-Encoding", "gzip")
        self.set_header("Content-Length", len(content))
        if include_body:
            self.write(content)


@functools.lru_cache(maxsize=_KEPT_FILES)
def _compressed(path: str, _changed: int) -> bytes:
    """Return a compressed file; `_changed`, the time of its last change, tells versions apart in the cache."""
    return gzip.compress(Path(path).read_bytes())
