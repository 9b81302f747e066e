"""Decorators for kernels, which run serially, without the GIL, cached on disk, in IEEE arithmetic with fused multiply-adds.

Numba is imported at the first use of a kernel: its import takes as long as all else that a command imports.
"""

from __future__ import annotations

import functools
import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from engine.integrator.jit.source_digests import hash_function

OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
"""Options of Numba for all kernels.

"contract" permits a fused multiply-add for a·b + c. Nothing else is reordered or assumed, so NaN is handled as usual.
"""

# Held while the dispatcher of a kernel is made.
_lock = threading.Lock()
# Subroutines that Numba does not know yet.
_new_subroutines: deque[Callable[..., Any]] = deque()


class Kernel:
    """A function that Numba compiles, or loads from the cache, at its first call for each argument type.

    Attributes
    ----------
    py_func
        The Python function.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        functools.update_wrapper(self, function)
        self.py_func = function
        # The sources may be replaced before the first call.
        self._source_hash = hash_function(function)
        self._dispatcher: Any = None

    @property
    def dispatcher(self) -> Any:
        """Numba's object for the function."""
        if self._dispatcher is None:
            with _lock:
                if self._dispatcher is None:
                    self._dispatcher = self._make_dispatcher()
        return self._dispatcher

    def _make_dispatcher(self) -> Any:
        from engine.integrator.jit.disk_cache import KernelCache

        dispatcher = make_dispatcher(self.py_func)
        # Numba's option `cache=True` sets this attribute to Numba's own cache, see `KernelCache`.
        dispatcher._cache = KernelCache(self.py_func, self._source_hash)
        return dispatcher

    @property
    def _numba_type_(self) -> Any:
        """The type with which other kernels call this kernel."""
        return self.dispatcher._numba_type_

    @property
    def signatures(self) -> list[Any]:
        """Argument types for which the kernel has been compiled."""
        return list(self.dispatcher.signatures)

    def __call__(self, *arguments: Any) -> Any:
        """Call the compiled function."""
        return self.dispatcher(*arguments)


def kernel(function: Callable[..., Any]) -> Any:
    """Return the function as a kernel."""
    return Kernel(function)


def subroutine(function: Callable[..., Any]) -> Any:
    """Return the function as a part of the kernels that call it; called by Python, the function runs uncompiled.

    A subroutine compiles in less time than a kernel, because it has no interface to Python, no file in the cache, and no second
    version for literal arguments. It is always inlined. Otherwise functions of the same name in several kernels would share the
    code from the kernel that is loaded first, in which the compiler may have rounded differently.
    """
    _new_subroutines.append(function)
    return function


def make_dispatcher(function: Callable[..., Any], **options: Any) -> Any:
    """Return Numba's object for a function that may call subroutines, without a cache, with more options of Numba."""
    from numba import njit
    from numba.core import config
    from numba.extending import register_jitable

    # Whether Numba inlines subroutines. Unoptimised code for WebAssembly is inlined later, see `kernel_module`.
    inlines = bool(config.OPT)  # type: ignore[attr-defined]
    while _new_subroutines:
        register_jitable(**OPTIONS, forceinline=inlines)(_new_subroutines.popleft())
    return njit(**OPTIONS, **options)(function)
