"""Turns of clients: the client whose last turn is longest ago is next."""

from __future__ import annotations

from collections.abc import Hashable, Iterable

from cachetools import LRUCache

# Number of clients whose last turns are remembered.
_KNOWN_CLIENTS = 1000


class LastTurns[Client: Hashable]:
    """Remembers the last turns of the latest clients."""

    def __init__(self) -> None:
        self._count = 0
        # Numbers of the last turns, from 1.
        self._numbers: LRUCache[Client, int] = LRUCache(_KNOWN_CLIENTS)

    def record(self, clients: Iterable[Client]) -> None:
        """Record that these clients have a turn now."""
        self._count += 1
        self._numbers.update(dict.fromkeys(clients, self._count))

    def last(self, client: Client) -> int:
        """Return the number of the last turn of a client, or 0. The smallest number is that of the next client."""
        return self._numbers.get(client, 0)
