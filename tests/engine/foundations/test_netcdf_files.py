"""A NetCDF file of which a bit has changed is refused, wherever the bit is. Other programs read and change the files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine.foundations.netcdf_files import read_netcdf, write_netcdf

DATASET = xr.Dataset({"fate": (("y", "x"), np.ones((30, 40), np.int8))}, {"x": np.linspace(0.0, 1.0, 40)}, {"potential": "III"})


@pytest.fixture
def file(tmp_path: Path) -> Path:
    write_netcdf(DATASET, tmp_path / "map.nc")
    return tmp_path / "map.nc"


def test_a_changed_bit_is_found_everywhere(file: Path) -> None:
    content = file.read_bytes()
    for place in range(8, len(content), 101):
        changed = bytearray(content)
        changed[place] ^= 1 << place % 8
        file.write_bytes(changed)
        with pytest.raises(
            OSError, match=r"^path=.*map\.nc: cannot be read as a NetCDF file: is damaged; restore it, or delete it"
        ):
            read_netcdf(file)


def test_a_lost_end_is_found(file: Path) -> None:
    content = file.read_bytes()
    for length in range(8, len(content) - 100, len(content) // 20):
        file.write_bytes(content[:length])
        with pytest.raises(OSError, match=r"^path=.*map\.nc: cannot be read as a NetCDF file"):
            read_netcdf(file)


def test_other_programs_read_the_file_and_may_change_it(file: Path) -> None:
    with xr.open_dataset(file) as opened:
        changed = opened.load().assign_attrs(potential="II")
    xr.testing.assert_identical(changed, DATASET.assign_attrs(potential="II"))
    changed.to_netcdf(file, mode="a")
    xr.testing.assert_identical(read_netcdf(file), changed)
