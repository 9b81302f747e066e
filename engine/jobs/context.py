"""What a job works with: the pool, the wish to stop, and the maps that are there already."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor
from dataclasses import dataclass
from typing import Any

from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec


@dataclass(frozen=True, eq=False)
class JobContext:
    """The place where one job is done.

    Attributes
    ----------
    executor
        Takes the parts of what is computed: each call is back within about 50 ms.
    call_executor
        Takes calls that compute something whole, and may last.
    cancel
        Set when nobody waits for the job any more.
    publish
        Hands a result on that is not complete yet.
    find_map
        On a bench, the map of a request, finished: kept, or computed for the purpose, or None when cancelled.
    find_answer
        On a bench, what another request of `engine.jobs.requests` comes to: kept, or made for the purpose.
    """

    executor: Executor
    call_executor: Executor
    cancel: threading.Event
    publish: Callable[[Any], None]
    find_map: Callable[[JobContext, MapSpec], EscapeMap | None]
    find_answer: Callable[[JobContext, Any], Any]

    def whole_map(self, spec: MapSpec) -> EscapeMap:
        """The map of a request, finished. Raises CancelledError when nobody waits for it any more."""
        whole = self.find_map(self, spec)
        if whole is None:
            raise CancelledError
        return whole

    def answer(self, spec: Any) -> Any:
        """What another request of `engine.jobs.requests` comes to."""
        return self.find_answer(self, spec)

    def on_pool[Result](self, compute: Callable[..., Result], *arguments: Any, **options: Any) -> Result:
        """What one call comes to, made by a thread that is there for computing."""
        return self.call_executor.submit(compute, *arguments, cancel=self.cancel, **options).result()
