"""The entries of an installed package are in the library, on the command line and on the page. Each test has its own process."""

from __future__ import annotations

import asyncio
import json
import os
import sys
import tomllib
from pathlib import Path

import pytest

from tests.extending import example_text
from tests.forked import Finished, run
from tests.packages import install

LAYER = """
from dataclasses import dataclass
from enum import IntEnum
from typing import ClassVar
import numpy as np
from escape_explorer import EscapeMap
from escape_explorer.plug_ins.layers import (
    CLEAR, Code, Job, Layer, Over, PixelAnalysis, Pixels, map_job, occurring_entries, read_only,
)
"""
STUDY = """
from collections.abc import Sequence
from dataclasses import dataclass
import numpy as np
from escape_explorer import Potential, Result, find_lyapunov_orbits
from escape_explorer.plug_ins.studies import (
    ENERGY, Chart, Frame, Job, Palette, Queue, Series, Settings, Shape, Study, changes_at, spaced_values,
)
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a package of the examples in docs/extending.md, whose entry `broken` fails."""
    heading = "Example: entries in a package of your own"
    points = tomllib.loads(example_text(heading, "toml"))["project"]["entry-points"]
    points["escape_explorer.layers"] = {"late": "my_layer:LATE"}
    points["escape_explorer.studies"] = {"periods": "my_study:PERIODS", "broken": "my_study:MISSING"}
    modules = {
        "my_escapes": example_text(heading),
        "my_layer": LAYER + example_text("Example: add a layer"),
        "my_study": STUDY + example_text("Example: add a study"),
    }
    (tmp_path / "site").mkdir()
    install(tmp_path / "site", "my-escapes", modules, points)
    return tmp_path


def use_library(folder: Path) -> None:
    sys.path.insert(0, str(folder / "site"))
    import escape_explorer
    from escape_explorer import MEASURES, POTENTIALS, SweepSpec, compute_sweep

    escape_explorer.compute_map  # noqa: B018
    before = "my_escapes" in sys.modules
    spec = SweepSpec(POTENTIALS["Quartic"], "x_px", (0.26, 0.3), (20, 20), t_max=50.0, measures=("mean_crossings",))
    found = compute_sweep(spec)
    print(before, list(MEASURES)[-1], found.axes, (found["mean_crossings"] > 0.0).tolist())  # noqa: T201
    print(found.plot(measure="mean_crossings").ax.get_ylabel())  # noqa: T201


def open_file(folder: Path) -> None:
    sys.path.insert(0, str(folder / "site"))
    from escape_explorer import open_result

    print(type(open_result(folder / "late.nc")).__name__)  # noqa: T201


def write_file(folder: Path) -> None:
    sys.path.insert(0, str(folder / "site"))
    from my_layer import find_late  # type: ignore[import-not-found]

    from escape_explorer import CASES, MapSpec, compute_map

    find_late(compute_map(MapSpec(CASES["II"], "x_px", 0.2, (20, 20), t_max=100.0))).save(folder / "late.nc")


def use_command_line(folder: Path, *arguments: str) -> None:
    sys.path.insert(0, str(folder / "site"))
    os.chdir(folder)
    from cli.main import main

    sys.exit(main(arguments))


def open_page(folder: Path) -> None:
    sys.path.insert(0, str(folder / "site"))
    from app.views.panels.analysis_choice import ANALYSIS_LABELS, LayerSwitches
    from tests.app.session.opened_page import opened_page

    async def show_entries() -> None:
        async with opened_page({"case": "Quartic", "late": "yes", "analysis": "periods"}) as (explorer, _):
            names = list(explorer.potential.panel.known.options.values())
            switch = LayerSwitches(explorer.state).switches["late"]
            shown = [explorer.links.view.system.case, *explorer.state.layers, explorer.state.analysis]
            print(json.dumps([names[-2], *shown, *switch.options, ANALYSIS_LABELS["periods"]]))  # noqa: T201

    asyncio.run(show_entries())


def test_the_library_has_the_system_and_the_measure_and_imports_the_package_when_it_is_used(folder: Path) -> None:
    assert run(folder, use_library, folder) == Finished(0, "False mean_crossings ('h',) [True, True]\ncrossings\n", "")


def test_files_of_the_results_of_a_package_are_opened(folder: Path) -> None:
    assert run(folder, write_file, folder).code == 0
    assert run(folder, open_file, folder) == Finished(0, "LateMap\n", "")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("potential", "--json"), '"Quartic"'),
        (
            ("measures", "Quartic", "--energy", "0.3", "--measure", "mean_crossings", "--resolution", "20", "--t-max", "50"),
            "cross",
        ),
        (("map", "II", "--energy", "0.2", "--late", "--resolution", "20", "--t-max", "100", "--output", "late.nc"), "late.nc"),
        (("study", "periods", "I", "--json", "--output", "periods.csv"), "periods.csv"),
    ],
)
def test_the_command_line_has_the_entries_and_warns_of_a_broken_one(
    folder: Path, arguments: tuple[str, ...], expected: str
) -> None:
    finished = run(folder, use_command_line, folder, *arguments)
    assert (finished.code, expected in finished.out) == (0, True)
    assert finished.err.count("escape_explorer.studies: broken of my-escapes is left out: AttributeError") == 1


def test_the_page_has_the_entries(folder: Path) -> None:
    finished = run(folder, open_page, folder)
    assert finished.code == 0, finished.err
    assert json.loads(finished.out) == ["Quartic", "Quartic", "late", "periods", "Late escapes", "Periods"]
