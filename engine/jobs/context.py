"""The interface between a job and the job manager: executors, cancellation, and results of other requests."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any, Protocol

from engine.jobs.cache import SupportsNbytes
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec


class JobRequest[Result: SupportsNbytes](Protocol):
    """A hashable request that computes its own result; it is the key of that result in the cache."""

    def __hash__(self) -> int: ...

    def run(self, context: JobContext) -> Result:
        """Compute the result. Raises CancelledError when the job is cancelled."""


@dataclass(frozen=True, eq=False)
class JobContext:
    """What a running job may use.

    Attributes
    ----------
    executor
        For many short calls, each of about 50 ms.
    long_call_executor
        For single calls that may take seconds.
    compilation_executor
        For compilations of kernels, one at a time.
    cancel
        Set when the job has no subscriber left.
    publish
        Sends a partial result to the subscribers.
    find_map
        Called with the context and the spec of a map; see `complete_map`.
    find_result
        Called with the context and a request; see `result`.
    """

    executor: Executor
    long_call_executor: Executor
    compilation_executor: Executor
    cancel: threading.Event
    publish: Callable[[Any], None]
    find_map: Callable[[JobContext, MapSpec], EscapeMap]
    find_result: Callable[[JobContext, Any], Any]

    def complete_map(self, spec: MapSpec) -> EscapeMap:
        """Return the complete map, from the cache or computed now. Raises CancelledError when the job is cancelled."""
        return self.find_map(self, spec)

    def result[Result: SupportsNbytes](self, request: JobRequest[Result]) -> Result:
        """Return the result of another request, from the cache or computed now and cached."""
        found: Result = self.find_result(self, request)
        return found

    def run_long_call[Result](self, function: Callable[..., Result], *arguments: Any, **options: Any) -> Result:
        """Call ``function(*arguments, cancel=self.cancel, **options)`` on a worker thread and wait for its result."""
        return self.long_call_executor.submit(function, *arguments, cancel=self.cancel, **options).result()
