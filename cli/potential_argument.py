"""The CASE argument: a catalogue name or a formula, with optional parameters."""

from __future__ import annotations

import re
import reprlib
from typing import Any

from engine import POTENTIALS, Potential, review_potential
from engine.service import PARAMETERS, TYPED, System
from plots.accepted_potentials import refusal


def find_potential(case: str) -> Potential:
    """Return the potential of ``NAME`` or of a formula in x and y, with optional parameters ``@omega_1=1.2,epsilon=0.8``.

    Raises
    ------
    ValueError
        If it is neither a name nor a formula, a parameter is invalid, or the potential is not supported.
    """
    potential = _find_system(case).potential
    problem = refusal(review_potential(potential))
    if problem is not None:
        raise ValueError(f"case={reprlib.repr(case)}: {problem}")
    return potential


def file_name_part(case: str) -> str:
    """Return the part of file names that identifies a potential."""
    name, _, parameters = case.partition("@")
    return re.sub(r"[^A-Za-z0-9_.+-]", "_", "-".join([name if name in POTENTIALS else TYPED, *filter(None, [parameters])]))


def _find_system(case: str) -> System:
    name, _, parameters = case.partition("@")
    chosen: dict[str, Any] = _read_parameters(case, parameters) if parameters else {}
    if name in POTENTIALS:
        return System(name, **chosen)
    system = System(TYPED, name, **chosen)
    try:
        _ = system.potential
    except ValueError as error:
        raise ValueError(
            f"case={reprlib.repr(case)}: must be one of {', '.join(POTENTIALS)}, or a formula in x and y ({error})"
        ) from None
    return system


def _read_parameters(case: str, text: str) -> dict[str, float]:
    chosen: dict[str, float] = {}
    for part in text.split(","):
        name, _, value = part.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = None
        if name.strip() not in PARAMETERS or number is None:
            raise ValueError(
                f"case={reprlib.repr(case)}: parameters are {', '.join(PARAMETERS)}, as in III@omega_1=1.1,epsilon=0.5"
            )
        chosen[name.strip()] = number
    return chosen
