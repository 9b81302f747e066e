"""What somebody who waits for a job holds."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any

log = logging.getLogger(__name__)


class Subscription:
    """One person's claim on a job. Cancelling it stops the job when nobody else waits for it."""

    def __init__(
        self, release: Callable[[Subscription], None], on_result: Callable[[Any], None], on_error: Callable[[Exception], None]
    ):
        self._release = release
        self._on_result = on_result
        self._on_error = on_error
        # An earlier frame that another thread hands over must not come after the last one.
        self._handing_over = threading.RLock()
        self.open = True
        """Whether anything is still to come."""

    def cancel(self) -> None:
        """Hear no more of it; at once, and as often as you like."""
        self.open = False
        self._release(self)

    def deliver(self, result: Any, *, last: bool) -> None:
        """Hand a frame or a result over, unless cancelled."""
        self._call(self._on_result, result, last)

    def fail(self, error: Exception) -> None:
        """Hand over what went wrong, unless cancelled."""
        self._call(self._on_error, error, True)

    def _call(self, receive: Callable[[Any], None], what: Any, last: bool) -> None:
        with self._handing_over:
            if not self.open:
                return
            self.open = not last
            try:
                receive(what)
            except Exception:
                # One listener's fault is no other listener's.
                log.exception("a listener failed")
