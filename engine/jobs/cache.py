"""Thread-safe least-recently-used cache of results, bounded by memory."""

from __future__ import annotations

import threading
from collections.abc import Hashable, Iterator
from typing import Any, Protocol

from cachetools import LRUCache


class SupportsNbytes(Protocol):
    """A result that reports its size in memory, as NumPy arrays do."""

    @property
    def nbytes(self) -> int:
        """Size in bytes."""


class ResultCache:
    """Least-recently-used cache of results.

    Parameters
    ----------
    limit
        Largest total size in bytes, 0 or more; larger results are not stored.
    """

    def __init__(self, limit: int) -> None:
        self._results: LRUCache[Hashable, Any] = LRUCache(limit, getsizeof=lambda result: result.nbytes)
        self._lock = threading.Lock()

    @property
    def limit(self) -> int:
        """Largest total size in bytes."""
        return int(self._results.maxsize)

    @property
    def nbytes(self) -> int:
        """Total size of the stored results in bytes."""
        return int(self._results.currsize)

    def get(self, key: Hashable) -> Any:
        """Return the result stored under a key, or None."""
        with self._lock:
            return self._results.get(key)

    def put(self, key: Hashable, result: SupportsNbytes) -> None:
        """Store a result, evicting the least recently used ones where space is needed."""
        with self._lock:
            self._results.pop(key, None)
            if result.nbytes <= self.limit:
                self._results[key] = result

    def __iter__(self) -> Iterator[Hashable]:
        """Iterate over a snapshot of the keys, without marking the results as used."""
        with self._lock:
            return iter(list(self._results))
