"""Coroutines run on a loop of their own: in the test's thread a browser's may be running."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any


def run_elsewhere[Result](make: Callable[[], Coroutine[Any, Any, Result]]) -> Result:
    """What a coroutine comes to."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(lambda: asyncio.run(make())).result()
