"""The examples run as they are, write what they say, and tell numbers that make sense."""

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
    """Where the example was run."""
    return tmp_path_factory.mktemp("case-three")


@pytest.fixture(scope="module")
def said(folder: Path) -> str:
    """What it printed."""
    run = subprocess.run(
        [sys.executable, "-W", "error", str(ROOT / "examples" / "a_day_with_case_three.py")],
        cwd=folder, env={**os.environ, "MPLBACKEND": "Agg", "PYTHONPATH": str(ROOT)},
        capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    return run.stdout


def numbers(said: str, pattern: str) -> list[float]:
    """The numbers that stand in the places marked # of a line."""
    line = re.search(re.escape(pattern).replace(r"\#", f"({NUMBER})"), said)
    assert line, pattern
    return [float(number) for number in line.groups()]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_it_opens_as_a_notebook_with_prose_before_every_cell_of_code(example: Path) -> None:
    cells = re.split(r"^# %%", example.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
    kinds = ["prose" if cell.startswith(" [markdown]\n") else "code" for cell in cells]
    assert kinds[0] == "prose"
    assert kinds.count("code") >= 5
    assert not any(pair == ("code", "code") for pair in pairwise(kinds))
    for cell, kind in zip(cells, kinds, strict=True):
        if kind == "prose":
            assert all(line.startswith("#") for line in cell.splitlines()[1:] if line)


@pytest.mark.slow
class TestCaseThree:
    def test_its_shares_add_up_and_mirror_images_are_equal(self, said: str) -> None:
        channels = [numbers(said, f"channel {k}: #")[0] for k in range(1, 5)]
        assert sum(channels) + numbers(said, "bounded: #")[0] == pytest.approx(1.0, abs=3e-4)
        assert channels[0] == channels[1] > channels[2] == channels[3] > 0.0
        assert numbers(said, "worst energy error: #")[0] < 1e-10

    def test_sali_tells_its_two_orbits_apart(self, said: str) -> None:
        assert numbers(said, "bounded orbit: SALI #")[0] > 0.1
        assert numbers(said, "late orbit: SALI #")[0] < 1e-7

    def test_shares_of_pixels_are_shares(self, said: str) -> None:
        for pattern in ("chaotic among the bounded: #", "doubtful pixels: #"):
            assert 0.0 < numbers(said, pattern)[0] < 0.5

    def test_the_papers_fit_is_near_the_counts_and_ours_nearer(self, said: str) -> None:
        rms = [float(value) for value in re.findall(rf"({NUMBER}) points root mean square", said)]
        assert len(rms) == 2
        assert 0.0 < rms[1] < rms[0] < 10.0

    def test_basin_entropies_stay_below_that_of_five_equal_fates(self, said: str) -> None:
        found = [(float(a), float(b)) for a, b in re.findall(rf"S_b ({NUMBER}), S_bb ({NUMBER})", said)]
        assert len(found) == 9
        assert all(0.0 < s_b < s_bb < np.log(5.0) for s_b, s_bb in found)

    def test_the_file_holds_the_map(self, said: str, folder: Path) -> None:
        assert "read back: h = 0.36" in said
        wanted = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.36, (120, 120), t_max=1e4))
        with xr.open_dataset(folder / "case-three.nc", engine="h5netcdf") as found:
            np.testing.assert_array_equal(found["fate"], wanted.fate)
            assert found.attrs["potential"] == CASES["III"].name

    @pytest.mark.usefixtures("said")
    @pytest.mark.parametrize("name", ["orbits", "against-energy", "basins"])
    def test_its_pictures_show_something(self, folder: Path, name: str) -> None:
        with Image.open(folder / f"{name}.png") as picture:
            assert min(picture.size) > 400
            colours = picture.convert("RGB").getcolors(maxcolors=picture.width * picture.height)
        assert colours is not None
        assert len(colours) > 50
