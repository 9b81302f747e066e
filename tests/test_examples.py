"""The examples run as scripts, open as notebooks, write their files and print plausible numbers."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from PIL import Image

from engine import CASES, MapSpec, Plane, compute_map

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
NUMBER = r"[-+]?[\d.]+(?:e[-+]?\d+)?"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the working directory of the example."""
    return tmp_path_factory.mktemp("case-three")


@pytest.fixture(scope="module")
def output(folder: Path) -> str:
    """Return the standard output of the example."""
    run = subprocess.run(
        [sys.executable, "-W", "error", str(ROOT / "examples" / "case_three.py")],
        cwd=folder, env={**os.environ, "MPLBACKEND": "Agg"},
        capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    return run.stdout


def numbers(output: str, pattern: str) -> list[float]:
    """Return the numbers of the output at the signs # of a pattern, which is a line of the output or a part of it."""
    line = re.search(re.escape(pattern).replace(r"\#", f"({NUMBER})"), output)
    assert line, pattern
    return [float(number) for number in line.groups()]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_is_a_notebook_with_text_before_every_code_cell(example: Path) -> None:
    cells = re.split(r"^# %%", example.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
    kinds = ["text" if cell.startswith(" [markdown]\n") else "code" for cell in cells]
    assert kinds[0] == "text"
    assert kinds.count("code") >= 5
    assert not any(pair == ("code", "code") for pair in pairwise(kinds))
    for cell, kind in zip(cells, kinds, strict=True):
        if kind == "text":
            assert all(line.startswith("#") for line in cell.splitlines()[1:] if line)


@pytest.mark.slow
class TestCaseThree:
    def test_shares_sum_to_one_and_respect_the_symmetry(self, output: str) -> None:
        channels = [numbers(output, f"channel {k}: #")[0] for k in range(1, 5)]
        assert sum(channels) + numbers(output, "bounded: #")[0] == pytest.approx(1.0, abs=3e-4)
        assert channels[0] == channels[1] > channels[2] == channels[3] > 0.0
        assert numbers(output, "worst energy error: #")[0] < 1e-10

    def test_sali_distinguishes_the_two_orbits(self, output: str) -> None:
        assert numbers(output, "bounded orbit: SALI #")[0] > 0.1
        assert numbers(output, "late orbit: SALI #")[0] < 1e-7

    def test_chaotic_and_doubtful_shares_are_between_0_and_a_half(self, output: str) -> None:
        for pattern in ("chaotic among the bounded: #", "doubtful pixels: #"):
            assert 0.0 < numbers(output, pattern)[0] < 0.5

    def test_the_published_fit_is_some_percentage_points_from_the_counts(self, output: str) -> None:
        assert 1.0 < numbers(output, "published fit: at most # percentage points")[0] < 25.0

    def test_basin_entropies_are_below_the_maximum_of_five_fates(self, output: str) -> None:
        found = [(float(a), float(b)) for a, b in re.findall(rf"S_b ({NUMBER}), S_bb ({NUMBER})", output)]
        assert len(found) == 9
        assert all(0.0 < s_b < s_bb < np.log(5.0) for s_b, s_bb in found)

    def test_netcdf_contains_the_map(self, output: str, folder: Path) -> None:
        assert "loaded: h = 0.36" in output
        wanted = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.36, (120, 120), t_max=1e4))
        with xr.open_dataset(folder / "case-three.nc", engine="h5netcdf") as found:
            np.testing.assert_array_equal(found["fate"], wanted.fate)
            assert found.attrs["potential"] == CASES["III"].name

    @pytest.mark.usefixtures("output")
    @pytest.mark.parametrize("name", ["orbits", "against-energy", "basins"])
    def test_pictures_are_not_empty(self, folder: Path, name: str) -> None:
        with Image.open(folder / f"{name}.png") as picture:
            assert min(picture.size) > 400
            colours = picture.convert("RGB").getcolors(maxcolors=picture.width * picture.height)
        assert colours is not None
        assert len(colours) > 50
