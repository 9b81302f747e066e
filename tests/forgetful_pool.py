"""Provide a thread pool that drops one call."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any


class ForgetfulPool(ThreadPoolExecutor):
    """Drops the call after `good_calls`, as a cluster does whose scheduler restarts. If given, `cancel` is set at this call."""

    def __init__(self, good_calls: int, cancel: threading.Event | None = None) -> None:
        super().__init__(2)
        self._numbers, self._dropped, self._cancel = itertools.count(), good_calls, cancel

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Any:
        if next(self._numbers) != self._dropped:
            return super().submit(function, *arguments, **named)
        if self._cancel is not None:
            self._cancel.set()
        future: Future[Any] = Future()
        future.cancel()
        future.set_running_or_notify_cancel()
        return future
