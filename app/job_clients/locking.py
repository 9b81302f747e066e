"""What a session's lock looks like to those who need it."""

from __future__ import annotations

from collections.abc import Callable

Locked = Callable[[Callable[..., None]], Callable[..., None]]
"""Turns a function into one that any thread may call, that returns at once and runs under the session's lock."""
