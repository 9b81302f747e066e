"""The decorators for kernels: serial, without the GIL, cached on disk, IEEE arithmetic with fused multiply-adds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit
from numba.core import config
from numba.extending import register_jitable

from engine.integrator.jit.disk_cache import KernelCache

# "contract" permits a fused multiply-add for a·b + c; nothing else is reordered or assumed, so NaN is handled as usual.
OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
"""Options of Numba for all kernels."""


# Instructions for another machine are inlined where they are optimised, see `engine.integrator.jit.kernel_module`.
_INLINES = bool(config.OPT)  # type: ignore[attr-defined]


def kernel(function: Callable[..., Any]) -> Any:
    """The function, compiled or loaded from the cache at its first call with arguments of some types."""
    compiled: Any = njit(**OPTIONS)(function)
    # Numba's own option `cache=True` sets this attribute to a cache of its own, see `KernelCache`.
    compiled._cache = KernelCache(function)
    return compiled


def subroutine(function: Callable[..., Any]) -> Any:
    """The function, compiled as a part of the kernels that call it; from Python it runs uncompiled.

    It compiles in less time than a kernel, because it has no interface to Python, no file in the cache, and no second version for
    arguments that are literals. It is always inlined: functions of the same name in several kernels would share the code of the
    kernel that is loaded first, and the compiler can round differently there.
    """
    return register_jitable(**OPTIONS, forceinline=_INLINES)(function)
