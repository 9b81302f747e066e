"""Turns on the event loop: one page at a time does what takes long, and visitors take turns, however many pages they have."""

from __future__ import annotations

import asyncio
from collections import defaultdict, deque
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from engine.jobs.last_turns import LastTurns


class VisitorTurns:
    """A lock of one event loop. Of the waiting visitors, the visitor whose last turn is longest ago gets the next turn."""

    def __init__(self) -> None:
        # The visitor whose turn it is; None if the turn is free.
        self._current_visitor: str | None = None
        self._waiting: defaultdict[str, deque[asyncio.Future[None]]] = defaultdict(deque)
        self._turns = LastTurns[str]()

    @asynccontextmanager
    async def turn(self, visitor: str) -> AsyncIterator[None]:
        """Wait for a turn of a visitor, which lasts as long as this context.

        Parameters
        ----------
        visitor
            The network of the visitor, see `app.runtime.visitors.network_of`.
        """
        await self._begin(visitor)
        try:
            yield
        finally:
            self._end()

    def are_wanted_by_others(self, visitor: str) -> bool:
        """Return whether a visitor other than this visitor has the turn or waits for a turn."""
        return self._current_visitor not in (None, visitor) or any(other != visitor for other in self._waiting)

    async def _begin(self, visitor: str) -> None:
        if self._current_visitor is not None:
            turn = asyncio.get_running_loop().create_future()
            self._waiting[visitor].append(turn)
            try:
                await turn
            except asyncio.CancelledError:
                # The turn may have been given to this task just before the task was cancelled.
                if not turn.cancelled():
                    self._end()
                raise
        self._current_visitor = visitor
        self._turns.record([visitor])

    def _end(self) -> None:
        """Give the turn to the next visitor; if nobody waits, free it."""
        self._current_visitor = None
        while self._waiting and self._current_visitor is None:
            visitor = min(self._waiting, key=self._turns.last)
            turn = self._waiting[visitor].popleft()
            if not self._waiting[visitor]:
                del self._waiting[visitor]
            # A task that is cancelled while it waits cancels its future.
            if not turn.done():
                self._current_visitor = visitor
                turn.set_result(None)
