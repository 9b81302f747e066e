"""A thread-safe cache of results in bounded memory."""

from __future__ import annotations

import threading
from collections.abc import Hashable, Iterator
from typing import Any

from cachetools import LRUCache

# Size at which a result without arrays is counted, in bytes.
_SMALL_SIZE = 1024

ABSENT: Any = object()
"""The value that marks a missing result where None is a possible result."""


class ResultCache:
    """A cache of results that drops the least recently used results.

    Parameters
    ----------
    limit
        Largest total size in bytes, 0 or more. A larger result is not stored. The size of a result is its attribute ``nbytes``;
        results without this attribute, or with 0 bytes, count as 1 KiB.
    """

    def __init__(self, limit: int) -> None:
        self._results: LRUCache[Hashable, Any] = LRUCache(limit, getsizeof=_size)
        self._lock = threading.Lock()

    @property
    def limit(self) -> int:
        """Largest total size in bytes."""
        return int(self._results.maxsize)

    @property
    def nbytes(self) -> int:
        """Total size of the stored results in bytes."""
        return int(self._results.currsize)

    def get(self, key: Hashable, default: Any = None) -> Any:
        """Return the result stored under a key, or the default."""
        with self._lock:
            return self._results.get(key, default)

    def put(self, key: Hashable, result: Any) -> None:
        """Store a result, evicting the least recently used results where space is needed."""
        with self._lock:
            self._results.pop(key, None)
            if _size(result) <= self.limit:
                self._results[key] = result

    def __iter__(self) -> Iterator[Hashable]:
        """Iterate over a snapshot of the keys, without marking the results as used."""
        with self._lock:
            return iter(list(self._results))


def _size(result: Any) -> int:
    """Return the size of a result, in bytes."""
    return getattr(result, "nbytes", 0) or _SMALL_SIZE
