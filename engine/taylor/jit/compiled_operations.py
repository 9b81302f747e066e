"""How much compiled code a process holds: Numba cannot unload it, so that a server has to limit it."""

from __future__ import annotations

import threading


class CompiledCodeLimitError(ValueError):
    """No more code can be compiled."""


class CompiledOperations:
    """The operations of all generated functions, each of which takes about 4 kB of memory when compiled.

    Attributes
    ----------
    used
        Number of operations so far.
    most
        Limit of their number; None for no limit.
    """

    def __init__(self) -> None:
        self.used = 0
        self.most: int | None = None
        self._lock = threading.Lock()

    def add(self, count: int) -> None:
        """Count operations before they are compiled. Raises `CompiledCodeLimitError` beyond the limit."""
        with self._lock:
            if self.most is not None and self.used + count > self.most:
                raise CompiledCodeLimitError(
                    "the integrators of as many different potentials are compiled as this program may keep until its next start; "
                    "choose a potential with the same powers of x and y as an earlier one"
                )
            self.used += count


compiled_operations = CompiledOperations()
"""Those of this process."""
