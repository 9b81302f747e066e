"""The files that are compiled in advance belong to the present sources, and compute what newly compiled systems compute."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine import MapSpec, Plane, System, read_section
from engine.foundations.execution import DEFAULT_EXECUTION
from engine.integrator.kernels.exit_geometry import REACH_COLUMN
from engine.integrator.portable_kernels import kernel_module
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.review.potential_review import review_system
from plots.browser.browser_system import compile_browser_system, file_name, is_system_compiled, make_browser_system
from plots.browser.compiled_files import FOLDER, KERNELS, browser_kernels, has_compiled
from tests.node import needs_node, run_node
from tests.plots.browser.test_agreement import as_view

COMMAND = "make the files again: uv run python -m plots.browser.compile_catalogue"
LARGEST_BYTES = 500_000
QUICK = "I", "Copenhagen"
# Tolerance of exits and windows. On another processor they differ in their last bits; exits are accurate to 1e-6.
ACCURACY = 1e-8
# Relative tolerance of reaches, which are multiples of the half widths of exits. Just above the saddle, these have fewer digits.
REACH_ACCURACY = 1e-6


def definition(name: str) -> tuple[Any, float, float]:
    """Return the potential of a system and its range of energies, as the page requests them."""
    review = review_system(System(name))
    return review.potential, review.energies.low, review.energies.high


def assert_same_data(found: Any, expected: Any) -> None:
    """Compare data with the same names and lengths, and with nearly equal numbers."""
    assert type(found) is type(expected)
    if isinstance(expected, dict):
        assert found.keys() == expected.keys()
        for name, value in expected.items():
            assert_same_data(found[name], value)
    elif isinstance(expected, list):
        assert len(found) == len(expected)
        for each, value in zip(found, expected, strict=True):
            assert_same_data(each, value)
    else:
        assert found == (pytest.approx(expected, rel=ACCURACY, abs=ACCURACY) if isinstance(expected, float) else expected)


def take_reaches(system: dict[str, Any]) -> list[float]:
    """Remove the reaches from the exits of a system, and return them."""
    return [row.pop(REACH_COLUMN) for each in system["exits"] for row in each.get("rows", ())]


def test_there_are_files_of_the_kernels_and_of_all_systems_and_no_others() -> None:
    assert has_compiled(KERNELS), COMMAND
    for name in CATALOGUE:
        assert is_system_compiled(*definition(name)), f"{name}: {COMMAND}"
    names = {f"{file_name(*definition(name))}.gz" for name in CATALOGUE}
    assert {path.name for path in FOLDER.iterdir()} == {*names, f"{KERNELS}.gz", "sources.sha256"}, COMMAND


def test_the_files_are_small() -> None:
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) < LARGEST_BYTES


def test_other_systems_sections_and_energies_have_no_file() -> None:
    potential, low, high = definition("III")
    assert not is_system_compiled(potential.in_rotating_frame(0.1), low, high)
    assert not is_system_compiled(potential, low, high, read_section("x = 0, px > 0"))
    assert not is_system_compiled(potential, low, np.nextafter(high, 2.0))


@needs_node
@pytest.mark.parametrize(
    "name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in CATALOGUE if name not in QUICK)]
)
def test_a_file_computes_what_a_newly_compiled_system_computes(name: str, tmp_path: Path) -> None:
    potential, low, high = definition(name)
    spec = MapSpec(potential, Plane.X_PX, review_system(System(name)).energies.first, (30, 30), t_max=1.0)
    stored, fresh = (
        make(potential, low, high, execution=DEFAULT_EXECUTION).to_dict()
        for make in (make_browser_system, compile_browser_system)
    )
    kernels: tuple[Callable[[], bytes], ...] = browser_kernels, kernel_module
    maps = [
        run_node(
            "run_view.js",
            {"module": system.pop("module"), "system": system, "kernels": make(), "views": [as_view(spec)]},
            tmp_path,
        )[0]
        for system, make in zip((stored, fresh), kernels, strict=True)
    ]
    assert take_reaches(stored) == pytest.approx(take_reaches(fresh), rel=REACH_ACCURACY)
    assert_same_data(stored, fresh)
    shares = [np.mean(np.array(maps[0][column]) == maps[1][column]) for column in ("fate", "crossings")]
    # Rounding may decide at boundaries of basins.
    assert min(shares) > 0.99, COMMAND
    assert np.mean(np.array(maps[0]["time"]) == maps[1]["time"]) > 0.99, COMMAND
