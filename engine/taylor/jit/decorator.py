"""The one way in which this package compiles: serial, without the GIL, cached, and with honest floating point."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit

from engine.taylor.jit.disk_cache import KernelCache


def kernel(function: Callable[..., Any]) -> Any:
    """The function, compiled at its first call with arguments of some types, or then loaded from the cache."""
    # "contract" lets a·b + c become one multiply-add; no other liberty is taken, so NaN and results stay what they are.
    compiled: Any = njit(nogil=True, error_model="numpy", fastmath={"contract"})(function)
    compiled._cache = KernelCache(function)
    return compiled
