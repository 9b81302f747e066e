"""The system in a link: a case or a formula, parameters of the well, and values of letters, as in ``letters=a:1.5,b:-2``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from engine import POTENTIALS, System
from engine.systems.formulas.formula_parser import LARGEST_VALUE, LONGEST_TEXT, checked_letter_value
from engine.systems.parameters import WELL_PARAMETERS
from engine.systems.system import TYPED
from plots.links.link_formats import Format, name_format, number_format
from plots.links.map_view import FIRST_MAP_VIEW

# Names of link parameters. All letters of a formula share one parameter, because single letters already name other parameters.
_CASE, _FORMULA, _LETTERS = "case", "V", "letters"


def write_system(system: System) -> dict[str, str]:
    """Return the link parameters of a system."""
    letters = system.letter_parameters
    parts: dict[str, Any] = {
        _CASE: system.case,
        **({_FORMULA: system.formula} if system.case == TYPED else {}),
        **{name: value for name, value in system.parameters.items() if name in WELL_PARAMETERS},
        **({_LETTERS: letters} if letters else {}),
    }
    return {name: SYSTEM_FORMATS[name].write(part) for name, part in parts.items()}


def system_of(parts: Mapping[str, Any]) -> tuple[System, list[str]]:
    """Return the system in a link, not reviewed yet, and a message if the link has parameters that the system does not have."""
    case = parts.get(_CASE, TYPED if _FORMULA in parts else FIRST_MAP_VIEW.system.case)
    formula = parts.get(_FORMULA, "")
    values = {**{name: parts[name] for name in WELL_PARAMETERS if name in parts}, **parts.get(_LETTERS, {})}
    legal = System(case, formula).parameter_names
    used_values = {name: value for name, value in values.items() if name in legal}
    system = System(case, formula, used_values)
    if used_values == values:
        return system, []
    advice = f"choose {', '.join(legal)}" if legal else "leave them out"
    return system, [f"Ignored the values of parameters that the system does not have: {advice}."]


def _write_letters(values: Mapping[str, float]) -> str:
    return ",".join(f"{name}:{value!r}" for name, value in values.items())


def _read_letters(text: str) -> dict[str, float]:
    pairs = [pair.split(":") for pair in text.split(",")]
    # The parameters of the well have link parameters of their own.
    if any(name in WELL_PARAMETERS for name, *_ in pairs):
        raise ValueError
    return {name: checked_letter_value(name, float(value)) for name, value in pairs}


SYSTEM_FORMATS: Mapping[str, Format] = {
    _CASE: name_format((*POTENTIALS, TYPED)),
    _FORMULA: Format(str, str, lambda: f"a formula in x and y of at most {LONGEST_TEXT} characters"),
    **{
        name: number_format(low, high, f"a number from {low:g} to {high:g}")
        for name, (_, _, (low, high)) in WELL_PARAMETERS.items()
    },
    _LETTERS: Format(
        _write_letters,
        _read_letters,
        lambda: f"letter:number pairs such as a:1.5,b:-2, from {-LARGEST_VALUE:g} to {LARGEST_VALUE:g}",
    ),
}
"""Text forms of the parts of a system, by their names in a link."""
