"""Subscriptions deliver the results of a job to a caller."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any

log = logging.getLogger(__name__)


class Subscription:
    """One caller's subscription to a job. The job is cancelled together with its last subscription.

    Parameters
    ----------
    release
        Called with the subscription when it is cancelled.
    on_result
        Called with each partial result and with the final result, from any thread but never concurrently.
    on_error
        Called with the exception if the job fails.
    """

    def __init__(
        self, release: Callable[[Subscription], None], on_result: Callable[[Any], None], on_error: Callable[[Exception], None]
    ):
        self._release = release
        self._on_result = on_result
        self._on_error = on_error
        # Held during a callback, because a partial result from another thread must not follow the final result.
        self._delivery_lock = threading.RLock()
        self.open = True
        """Whether more results, or an error, may follow."""

    def cancel(self) -> None:
        """Close the subscription, without waiting. It receives nothing more. Repeated calls are allowed."""
        self.open = False
        self._release(self)

    def deliver(self, result: Any, *, last: bool) -> None:
        """Pass a partial or final result to the caller, unless the subscription is closed."""
        self._call(self._on_result, result, last)

    def fail(self, error: Exception) -> None:
        """Pass an exception to the caller, unless the subscription is closed."""
        self._call(self._on_error, error, True)

    def _call(self, callback: Callable[[Any], None], value: Any, last: bool) -> None:
        """Call a callback, unless the subscription is closed; close it after the last call."""
        with self._delivery_lock:
            if not self.open:
                return
            self.open = not last
            try:
                callback(value)
            except Exception:
                # An exception in one subscriber must not affect other subscribers.
                log.exception("a callback of a job failed")
