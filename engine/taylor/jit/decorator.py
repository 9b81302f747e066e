"""The decorator for kernels: serial, without the GIL, cached on disk, IEEE arithmetic with fused multiply-adds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit

from engine.taylor.jit.disk_cache import KernelCache


def kernel(function: Callable[..., Any]) -> Any:
    """The function, compiled or loaded from the cache at its first call with arguments of some types."""
    # "contract" permits a fused multiply-add for a·b + c; nothing else is reordered or assumed, so NaN is handled as usual.
    compiled: Any = njit(nogil=True, error_model="numpy", fastmath={"contract"})(function)
    # Numba's own option `cache=True` sets this attribute to a cache of its own, see `KernelCache`.
    compiled._cache = KernelCache(function)
    return compiled
