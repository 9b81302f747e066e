"""The one way in which this package compiles: serial, without the GIL, cached, and with honest floating point."""

from __future__ import annotations

from numba import njit

# "contract" lets a·b + c become one multiply-add; no other liberty is taken, so NaN and results stay what they are.
kernel = njit(nogil=True, cache=True, error_model="numpy", fastmath={"contract"})
