"""Results kept for the next one who asks, in bounded memory."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable, Iterator
from typing import Any, Protocol


class Sized(Protocol):
    """A result that knows its size in memory."""

    @property
    def nbytes(self) -> int:
        """Bytes held."""


class ResultCache:
    """Least recently used results, together at most `limit` bytes."""

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.nbytes = 0
        self._results: OrderedDict[Hashable, Any] = OrderedDict()

    def get(self, key: Hashable) -> Any:
        """The result, None when it is not kept."""
        if key in self._results:
            self._results.move_to_end(key)
        return self._results.get(key)

    def put(self, key: Hashable, result: Sized) -> None:
        """Keep a result, at the cost of the ones not used for longest; one larger than the limit is not kept."""
        self._drop(key)
        if result.nbytes > self.limit:
            return
        self._results[key] = result
        self.nbytes += result.nbytes
        while self.nbytes > self.limit:
            self._drop(next(iter(self._results)))

    def __iter__(self) -> Iterator[Hashable]:
        return iter(list(self._results))

    def _drop(self, key: Hashable) -> None:
        if key in self._results:
            self.nbytes -= self._results.pop(key).nbytes
