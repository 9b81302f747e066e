"""Static files, compressed for browsers that accept gzip. The scripts of Bokeh and Panel shrink to a quarter."""

from __future__ import annotations

import functools
import gzip
from pathlib import Path

from tornado.ioloop import IOLoop
from tornado.web import StaticFileHandler

from app.browser.module_files import accepts_gzip

# Suffixes of the files to compress. Other types are compressed already.
_SUFFIXES = frozenset({".js", ".mjs", ".css", ".svg", ".json", ".map"})
# Number of compressed files in the cache. Together, they take a few megabytes.
_CACHED_FILES = 64


class CompressedFiles(StaticFileHandler):
    """Mixin that makes a handler of static files answer with compressed files."""

    _is_compressed = False

    async def get(self, path: str, include_body: bool = True) -> None:
        """Answer with a compressed file if the browser accepts gzip and the type is in `_SUFFIXES`, else like other handlers."""
        if Path(path).suffix in _SUFFIXES:
            self.set_header("Vary", "Accept-Encoding")
            # A range counts bytes of the uncompressed file.
            headers = self.request.headers
            self._is_compressed = accepts_gzip(headers.get("Accept-Encoding", "")) and "Range" not in headers
        if not self._is_compressed:
            await super().get(path, include_body)
            return
        # The following steps are those of Tornado's method, which would send the file itself.
        self.path = self.parse_url_path(path)
        absolute_path = self.validate_absolute_path(self.root, self.get_absolute_path(self.root, self.path))
        if absolute_path is None:
            return
        self.absolute_path = absolute_path
        self.modified = self.get_modified_time()
        self.set_headers()
        if self.should_return_304():
            self.set_status(304)
            return
        change_time = Path(absolute_path).stat().st_mtime_ns
        # Compressing takes up to 0.1 s, once for each version of a file.
        content = await IOLoop.current().run_in_executor(None, _compress, absolute_path, change_time)
        self.set_header("Content-Encoding", "gzip")
        self.set_header("Content-Length", len(content))
        if include_body:
            self.write(content)

    def compute_etag(self) -> str | None:
        """Return the tag of the file. The compressed file has a tag of its own."""
        tag = super().compute_etag()
        return f'{tag[:-1]}-gzip"' if tag and self._is_compressed else tag


@functools.lru_cache(maxsize=_CACHED_FILES)
def _compress(path: str, _change_time: int) -> bytes:
    """Return the compressed content of a file. `_change_time` distinguishes the versions of a file in the cache."""
    return gzip.compress(Path(path).read_bytes())
