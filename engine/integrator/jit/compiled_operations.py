"""A limit on the compiled code of a process, for servers, because Numba cannot unload code.

A code is the generated functions of one structure, named by its digest. An account is any key, such as a visitor's address.
"""

from __future__ import annotations

import threading
from collections.abc import Hashable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

LARGEST_CODE = 40_000
"""Largest number of operations of one code if there is a limit: about that of the largest code of the catalogue."""

SHARES = 4
"""Number of equal shares of the limit; an account may use one share."""

# Advice at the end of messages.
_ADVICE = "choose a potential with the same powers of x and y as an earlier one, or one of the catalogue"

_account: ContextVar[Hashable] = ContextVar("account", default=None)


class CompiledCodeLimitError(ValueError):
    """The code is too large, or the limit of the process or of the account is reached."""


class CompiledOperations:
    """Counts the operations of all generated functions. An operation takes 0.1 kB, or 2 kB if compiled in this process.

    Code that is reserved is always compiled, and does not count.

    Attributes
    ----------
    limit
        Largest number of operations that count; None for no limit.
    """

    def __init__(self) -> None:
        self.limit: int | None = None
        # The operations and the account of each code.
        self._entries: dict[str, tuple[int, Hashable]] = {}
        self._reserved: set[str] = set()
        self._lock = threading.Lock()

    @property
    def used(self) -> int:
        """Number of operations of the codes so far, without reserved codes."""
        with self._lock:
            return sum(count for count, _ in self._counted_codes())

    @property
    def codes(self) -> frozenset[str]:
        """The digests of all codes so far."""
        with self._lock:
            return frozenset(self._entries)

    def is_nearly_full(self) -> bool:
        """Return whether less than the share of one account is left."""
        return self.limit is not None and self.limit - self.used < self.limit // SHARES

    def reserve(self, codes: Iterable[str]) -> None:
        """Exempt these codes, named by their digests, from the limit."""
        with self._lock:
            self._reserved.update(codes)

    def add(self, code: str, count: int) -> None:
        """Count the operations of a code before it is compiled; raise `CompiledCodeLimitError` beyond a limit."""
        account = _account.get()
        with self._lock:
            if self.limit is not None and code not in self._reserved:
                self._check(count, account, self.limit)
            self._entries[code] = count, account

    def _check(self, count: int, account: Hashable, limit: int) -> None:
        """Raise `CompiledCodeLimitError` if a code of `count` operations exceeds a limit."""
        if count > LARGEST_CODE:
            raise CompiledCodeLimitError(
                f"the integrator of this potential has {count} operations, and at most {LARGEST_CODE} are compiled here; "
                "choose a potential with fewer terms"
            )
        if sum(used for used, _ in self._counted_codes()) + count > limit:
            raise CompiledCodeLimitError(
                "the integrators of as many different potentials are compiled as this program may keep until its next start; "
                f"{_ADVICE}"
            )
        own_count = sum(used for used, owner in self._counted_codes() if owner == account)
        if account is not None and own_count + count > limit // SHARES:
            raise CompiledCodeLimitError(
                f"your address has compiled the integrators of as many different potentials as it may; {_ADVICE}"
            )

    def _counted_codes(self) -> Iterator[tuple[int, Hashable]]:
        """Return the operations and the account of each code that is not reserved."""
        return (entry for code, entry in self._entries.items() if code not in self._reserved)


compiled_operations = CompiledOperations()
"""The operations of this process."""


@contextmanager
def charged_to(account: Hashable) -> Iterator[None]:
    """Charge code that is compiled in this context to an account; None charges no account."""
    token = _account.set(account)
    try:
        yield
    finally:
        _account.reset(token)
