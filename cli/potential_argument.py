"""The CASE argument: a catalogue name or a formula, with optional parameters."""

from __future__ import annotations

import re
import reprlib

from engine import POTENTIALS, Potential, System, review_potential
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.formulas.formula_parser import formula_letters
from engine.systems.parameters import WELL_PARAMETERS
from engine.systems.system import TYPED
from plots.texts.accepted_potentials import refusal


def find_potential(case: str) -> Potential:
    """Return the potential of ``NAME`` or of a formula in x and y, with optional parameters ``@omega_1=1.2,a=0.8``.

    Raises
    ------
    ValueError
        If it is neither a name nor a formula, a parameter is invalid, or the potential is not supported.
    """
    potential = find_system(case).potential
    problem = refusal(review_potential(potential))
    if problem is not None:
        raise ValueError(f"case={reprlib.repr(case)}: {problem}")
    return potential


def file_name_part(case: str) -> str:
    """Return the part of file names that identifies a potential."""
    name, _, parameters = case.partition("@")
    return re.sub(r"[^A-Za-z0-9_.+-]", "_", "-".join([name if name in POTENTIALS else TYPED, *filter(None, [parameters])]))


def find_system(case: str) -> System:
    """Return the system of a case, which is not reviewed; ValueError if there is none."""
    name, _, parameters = case.partition("@")
    chosen = _read_parameters(case, name, parameters) if parameters else {}
    if name in POTENTIALS:
        return System(name, "", chosen)
    system = System(TYPED, name, chosen)
    try:
        _ = system.potential
    except ValueError as error:
        raise ValueError(
            f"case={reprlib.repr(case)}: must be one of {', '.join(POTENTIALS)}, or a formula in x and y ({error})"
        ) from None
    return system


def _read_parameters(case: str, formula: str, text: str) -> dict[str, float]:
    legal = CATALOGUE[formula].adjustable if formula in CATALOGUE else (*WELL_PARAMETERS, *_letters(formula))
    chosen: dict[str, float] = {}
    for part in text.split(","):
        name, _, value = part.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = None
        if name.strip() not in legal or number is None:
            raise ValueError(f"case={reprlib.repr(case)}: parameters are {', '.join(legal)}, as in III@omega_1=1.1,epsilon=0.5")
        chosen[name.strip()] = number
    return chosen


def _letters(formula: str) -> tuple[str, ...]:
    """The letters of a formula; none for text that is no formula, which is refused later."""
    try:
        return formula_letters(formula)
    except ValueError:
        return ()
