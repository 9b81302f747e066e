"""Run coroutines on a new event loop in a thread, because browser tests leave an event loop running in the main thread."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any


def run_on_new_loop[Result](make: Callable[[], Coroutine[Any, Any, Result]]) -> Result:
    """Return the result of a coroutine."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(lambda: asyncio.run(make())).result()
