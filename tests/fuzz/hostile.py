"""Values that nobody should send, and what may become of them."""

from __future__ import annotations

import re
import resource
import time
import warnings
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from hypothesis import strategies as st

MOST_SECONDS = 20.0
"""Of processor time, for the answer to any request or its refusal; what is asked for here is small."""

MOST_BYTES = 1.5e9
"""Most memory of the whole test process, at any time."""

LONGEST_SENTENCE = 2000
"""Most characters of a refusal: no caller's novel comes back to him."""

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
        None,
        True,
        False,
        b"",
        b"0.2",
        (),
        [],
        {},
        object(),
        1 + 2j,
        np.array(0.2),
        np.array([0.1, 0.2]),
        np.float32(0.2),
        ValueError,
    )
)
anything = floats | texts | odd_objects | st.lists(floats, max_size=5) | st.tuples(floats, floats) | st.integers()


# What makes up formulas, right ones and wrong ones, and parameters after them.
PIECES = (
    "x", "y", "r", "x²", "y^3", "x^4", "r²", "r^4", "2", "0.5", "½", "1e3", "1e-9", "1e999", "^2", "^12", "^99", "(", ")", "+",
    "-", "−", "*", "/", "·", " ", "V=", "=", "@", "epsilon=", "omega_1=", ",", "<b>", "&lt;", "nan", "\0", "９", "٣",
)  # fmt: skip
pieces_in_a_row = st.lists(st.sampled_from(PIECES), max_size=12).map("".join)
monomials = st.builds("{:.3g}*x^{}*y^{}".format, st.floats(-9.0, 9.0), st.integers(0, 6), st.integers(0, 6))
polynomials = st.lists(monomials, min_size=1, max_size=4).map(lambda terms: "0.5*(x^2+y^2)+" + "+".join(terms))
KNOWN_FORMULAS = ("½(x² + y²) − x²y²", "0.5(x^2+y^2) - x^2 y + y^3/3", "r^2/2 - x^4 - y^4", "x^2+y^2", "V(x,y) = x - y")
formulas = st.one_of(polynomials, st.sampled_from(KNOWN_FORMULAS), pieces_in_a_row, texts)
NAMED = ("I", "III", "C5", "HH", "One exit", "typed", "")


def _after(names: list[tuple[str, str]]) -> str:
    return ("@" + ",".join(f"{name}={value}" for name, value in names)) if names else ""


_parameters = st.lists(
    st.tuples(
        st.sampled_from(("omega_1", "omega_2", "epsilon", "mass", "")), st.floats(0.1, 2.0).map(repr) | floats.map(repr) | texts
    ),
    max_size=3,
).map(_after)
case_strings = st.builds("{}{}".format, st.sampled_from(NAMED) | formulas, _parameters)
"""As the command line takes them: a name or a formula, and parameters behind @."""


def either[Value](good: st.SearchStrategy[Value], bad: st.SearchStrategy[Any] = anything) -> st.SearchStrategy[Any]:
    """Mostly good values, so that a bad one does not always hide behind another."""
    return st.one_of(good, good, good, bad)


def answer_or_refusal(ask: Callable[[], Any], names: Iterable[str]) -> Any:
    """What a request is answered with, or None where it is refused as it should be.

    A refusal is a ValueError with a sentence that names one of the parameters, or a TypeError where a value is of a type that no
    number, name or list can be made of.
    """
    begun = time.process_time()
    answer = None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            answer = ask()
    except ValueError as error:
        sentence = str(error)
        assert any(re.search(rf"\b{name}\b", sentence) for name in names), f"names no parameter: {sentence[:300]}"
        assert len(sentence) <= LONGEST_SENTENCE, f"{len(sentence)} characters: {sentence[:300]}"
    except TypeError:
        pass
    assert time.process_time() - begun < MOST_SECONDS
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 < MOST_BYTES
    return answer
