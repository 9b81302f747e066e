"""Decorators for kernels, which run serially, without the GIL, cached on disk, in IEEE arithmetic with fused multiply-adds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit
from numba.core import config
from numba.extending import register_jitable

from engine.integrator.jit.disk_cache import KernelCache

OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
"""Options of Numba for all kernels.

"contract" permits a fused multiply-add for a·b + c. Nothing else is reordered or assumed, so NaN is handled as usual.
"""

# Whether Numba inlines subroutines. Unoptimised code for WebAssembly is inlined later, see `kernel_module`.
_INLINES = bool(config.OPT)  # type: ignore[attr-defined]


def kernel(function: Callable[..., Any]) -> Any:
    """Return the function as a kernel, which is compiled or loaded from the cache at its first call for each argument type."""
    compiled: Any = njit(**OPTIONS)(function)
    # Numba's option `cache=True` sets this attribute to Numba's own cache, see `KernelCache`.
    compiled._cache = KernelCache(function)
    return compiled


def subroutine(function: Callable[..., Any]) -> Any:
    """Return the function as a part of the kernels that call it; called by Python, the function runs uncompiled.

    A subroutine compiles in less time than a kernel, because it has no interface to Python, no file in the cache, and no second
    version for literal arguments. It is always inlined. Otherwise functions of the same name in several kernels would share the
    code from the kernel that is loaded first, in which the compiler may have rounded differently.
    """
    return register_jitable(**OPTIONS, forceinline=_INLINES)(function)
