"""Make invalid and extreme input, and check the limits that every response must keep."""

from __future__ import annotations

import re
import time
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

MOST_SECONDS = 20.0
"""Longest processor time of any request, in seconds. Valid requests in these tests are small."""

MOST_BYTES = 1.0e9
"""Largest additional memory at any moment of a request."""

LONGEST_MESSAGE = 2000
"""Largest number of characters of an error message, which must not repeat long input in full."""

EXTREMES = (
    float("nan"), float("inf"), float("-inf"), 0.0, -0.0, 5e-324, -5e-324, 2.2e-308, 1e-300, 1e-30, 1e-16, 1.7e308, -1.7e308,
    1e16, 1e9, 1e6, -1.0, -1e-9, 2**53 + 1, 2**63, 10**400, -(10**400),
)  # fmt: skip
STRINGS = (
    "", " ", "nan", "inf", "0.2", "1e999", "--help", "-1", "I", "<img src=x onerror=alert(1)>", "<script>alert(1)</script>",
    "'; DROP TABLE maps; --", '"', "'", "\0", "a\0b", "\n", "\r\n", "\x1b[2J", "../../../no/such/file", "/no/such/file",
    "${HOME}", "$(touch x)", "`id`", "{0.__class__}", "%s%n", "__import__('os')", "ＩＩ", "١", "ß", "\u202e", "🜁", "\ud800",
    "x" * 10_000, "9" * 5_000, "0x1p3", "1_000", "1,2", "NaN ", "true",
)  # fmt: skip

floats = st.sampled_from(EXTREMES) | st.floats() | st.floats(-2.0, 2.0)
texts = st.sampled_from(STRINGS) | st.text(max_size=40)
odd_objects = st.sampled_from(
    (
        None, True, False, b"", b"0.2", (), [], {}, object(), 1 + 2j, np.array(0.2), np.array([0.1, 0.2]), np.float32(0.2),
        ValueError,
    )
)  # fmt: skip
anything = floats | texts | odd_objects | st.lists(floats, max_size=5) | st.tuples(floats, floats) | st.integers()

# Parts of valid and invalid formulas and of their parameters.
PIECES = (
    "x", "y", "r", "x²", "y^3", "x^4", "r²", "r^4", "2", "0.5", "½", "1e3", "1e-9", "1e999", "^2", "^12", "^99", "(", ")", "+",
    "-", "−", "*", "/", "·", " ", "V=", "=", "@", "epsilon=", "omega_1=", ",", "<b>", "&lt;", "nan", "\0", "９", "٣",
)  # fmt: skip
random_formulas = st.lists(st.sampled_from(PIECES), max_size=12).map("".join)
monomials = st.builds("{:.3g}*x^{}*y^{}".format, st.floats(-9.0, 9.0), st.integers(0, 6), st.integers(0, 6))
polynomials = st.lists(monomials, min_size=1, max_size=4).map(lambda terms: "0.5*(x^2+y^2)+" + "+".join(terms))
KNOWN_FORMULAS = ("½(x² + y²) − x²y²", "0.5(x^2+y^2) - x^2 y + y^3/3", "r^2/2 - x^4 - y^4", "x^2+y^2", "V(x,y) = x - y")
formulas = st.one_of(polynomials, st.sampled_from(KNOWN_FORMULAS), random_formulas, texts)
"""Potentials as arguments of the command line: a name or a formula, then parameters after @."""


def mostly[Value](valid: st.SearchStrategy[Value], invalid: st.SearchStrategy[Any] = anything) -> st.SearchStrategy[Any]:
    """Return a strategy with three valid values in four, so that several invalid values seldom occur together."""
    return st.one_of(valid, valid, valid, invalid)


@contextmanager
def limited_resources() -> Iterator[None]:
    """Assert that the body takes little processor time and memory, whatever earlier tests left in this process."""
    begun, before = time.process_time(), _resident_bytes("VmRSS")
    # The peak begins anew, see proc(5).
    Path("/proc/self/clear_refs").write_text("5")
    yield
    assert time.process_time() - begun < MOST_SECONDS
    assert _resident_bytes("VmHWM") - before < MOST_BYTES


def _resident_bytes(kind: str) -> int:
    """Return the resident memory of this process, VmRSS, or its peak, VmHWM."""
    (line,) = (line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith(kind))
    return 1024 * int(line.split()[1])


def result_or_error(call: Callable[[], Any], names: Iterable[str]) -> Any:
    """Return the result of a call, or None if it raises an allowed exception.

    Allowed are a ValueError whose message contains one of the parameter names, and a TypeError.
    """
    result = None
    with limited_resources():
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                result = call()
        except ValueError as error:
            message = str(error)
            assert any(re.search(rf"\b{name}\b", message) for name in names), f"no parameter name: {message[:300]}"
            assert len(message) <= LONGEST_MESSAGE, f"{len(message)} characters: {message[:300]}"
        except TypeError:
            pass
    return result
