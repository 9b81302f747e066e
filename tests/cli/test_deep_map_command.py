"""Command ``deep-map``."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from cli.main import INVALID_REQUEST, main
from engine import CASES, MapSpec, Plane, compute_deep_map

ARGUMENTS = ["deep-map", "II", "--energy", "0.25", "--width", "1e-22", "--resolution", "6x4", "--t-max", "100"]
CENTRE = ("0.171759434640462745447484517354", "1/20")


def test_files_have_the_map_of_the_library(tmp_path: Path) -> None:
    assert main([*ARGUMENTS, "--centre", *CENTRE, "--output", str(tmp_path / "deep")]) == 0
    with xr.open_dataset(tmp_path / "deep.nc", engine="h5netcdf") as found:
        wanted = compute_deep_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (6, 4), t_max=100.0), CENTRE, 1e-22)
        assert np.array_equal(found["fate"].values, wanted.fate)
        assert found.attrs["arithmetic"] == "double-double"
    assert (tmp_path / "deep.png").read_bytes().startswith(b"\x89PNG")


def test_a_centre_that_is_no_number_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*ARGUMENTS, "--centre", "0.1", "x", "--output", str(tmp_path / "deep")]) == INVALID_REQUEST
    assert "centre=('0.1', 'x'): must be two numbers" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
