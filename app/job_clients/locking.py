"""Type of the function that runs callbacks under a session's lock."""

from __future__ import annotations

from collections.abc import Callable

Locked = Callable[[Callable[..., None]], Callable[..., None]]
"""Wraps a function: any thread may call the result, which returns at once and runs the function under the session's lock."""
