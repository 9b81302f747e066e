"""How much compiled code a process holds: Numba cannot unload it, so that a server has to limit it."""

from __future__ import annotations

import threading
from collections.abc import Hashable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

LARGEST_CODE = 40_000
"""Most operations of one code where there is a limit; the largest of the catalogue has about as many."""

SHARES = 4
"""An account may have this part of the limit, one quarter."""

_account: ContextVar[Hashable] = ContextVar("account", default=None)


class CompiledCodeLimitError(ValueError):
    """No more code can be compiled."""


class CompiledOperations:
    """The operations of all generated functions, each of which takes about 0.4 kB of memory, 1 kB if it is compiled here.

    Code that is reserved is always compiled, and does not count.

    Attributes
    ----------
    most
        Limit of the number of operations that count; None for no limit.
    """

    def __init__(self) -> None:
        self.most: int | None = None
        # By code: its operations and the account.
        self._compiled: dict[str, tuple[int, Hashable]] = {}
        self._reserved: set[str] = set()
        self._lock = threading.Lock()

    @property
    def used(self) -> int:
        """Number of operations so far that count."""
        with self._lock:
            return sum(count for count, _ in self._counted())

    @property
    def codes(self) -> frozenset[str]:
        """The digests of all codes so far."""
        with self._lock:
            return frozenset(self._compiled)

    def is_nearly_full(self) -> bool:
        """Whether less is left than one account may have."""
        return self.most is not None and self.most - self.used < self.most // SHARES

    def reserve(self, codes: Iterable[str]) -> None:
        """Let these codes, named by their digests, always be compiled."""
        with self._lock:
            self._reserved.update(codes)

    def add(self, code: str, count: int) -> None:
        """Count the operations of a code before it is compiled. Raises `CompiledCodeLimitError` beyond a limit."""
        account = _account.get()
        with self._lock:
            if self.most is not None and code not in self._reserved:
                self._check(count, account, self.most)
            self._compiled[code] = count, account

    def _check(self, count: int, account: Hashable, most: int) -> None:
        if count > LARGEST_CODE:
            raise CompiledCodeLimitError(
                f"the integrator of this potential has {count} operations, and at most {LARGEST_CODE} are compiled here; "
                "choose a potential with fewer terms"
            )
        if sum(used for used, _ in self._counted()) + count > most:
            raise CompiledCodeLimitError(
                "the integrators of as many different potentials are compiled as this program may keep until its next start; "
                f"{_SAME_POWERS}"
            )
        if account is not None and sum(used for used, whose in self._counted() if whose == account) + count > most // SHARES:
            raise CompiledCodeLimitError(
                f"your address has compiled the integrators of as many different potentials as it may; {_SAME_POWERS}"
            )

    def _counted(self) -> Iterator[tuple[int, Hashable]]:
        return (counted for code, counted in self._compiled.items() if code not in self._reserved)


_SAME_POWERS = "choose a potential with the same powers of x and y as an earlier one, or one of the catalogue"

compiled_operations = CompiledOperations()
"""Those of this process."""


@contextmanager
def charged_to(account: Hashable) -> Iterator[None]:
    """Count what is compiled within this context for an account; for none if it is None."""
    token = _account.set(account)
    try:
        yield
    finally:
        _account.reset(token)
