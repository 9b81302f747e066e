"""The completion of names shows only names for users."""

from __future__ import annotations

import rlcompleter
import subprocess
import sys

import pytest

from engine import CASES, MapSpec, compute_map, integrate_orbit

INNER = {
    "codes",
    "columns",
    "fate_labels",
    "held_as",
    "numbers",
    "row_dimension",
    "shown_numbers",
    "certificate",
    "certifies_tori",
}
THINGS = {
    "potential": (CASES["I"], {"value", "saddles", "in_rotating_frame", "save"}, {"lineage", "check_at_rest", "well", *INNER}),
    "map": (
        compute_map(MapSpec(CASES["I"], "x_px", 0.2, (8, 8), t_max=5.0)),
        {"fate", "fractions", "spec", "to_xarray"},
        {"batch", "started", "stride", "thinned", *INNER},
    ),
    "orbit": (integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.6), 5.0), {"x", "sali", "find_section_crossings", "plot"}, INNER),
}


@pytest.mark.parametrize("name", THINGS)
def test_the_names_of_a_result_are_those_for_users(name: str) -> None:
    thing, wanted, inner = THINGS[name]
    names = set(dir(thing))
    assert wanted <= names
    assert not inner & names


def test_a_prompt_does_not_complete_inner_names() -> None:
    completer = rlcompleter.Completer({"p": CASES["I"]})
    assert completer.complete("p.lin", 0) is None
    assert completer.complete("p.in_r", 0) == "p.in_rotating_frame("


def test_all_names_can_be_imported_at_once_without_the_page() -> None:
    code = "from escape_explorer import *; import sys; print(*sys.modules); compute_map, FormulaError, open_result"
    modules = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.split()
    assert "engine" in modules
    assert {"numba", "panel", "bokeh", "matplotlib"}.isdisjoint(modules)
