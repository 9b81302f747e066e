"""The file of a map has the variables of its layers, and opens as the map."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from engine import CASES, MapSpec, Plane, compute_map, compute_origin_fates, compute_trust, open_result
from plots.texts.exports import netcdf_bytes


def test_a_map_with_results_of_layers_opens_as_the_map(tmp_path: Path) -> None:
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (20, 20), t_max=200.0))
    analyses = {"origins": compute_origin_fates(frame.spec), "trust": compute_trust(frame)}
    (tmp_path / "map.nc").write_bytes(netcdf_bytes(frame, analyses))
    opened = open_result(tmp_path / "map.nc")
    with xr.open_dataset(tmp_path / "map.nc") as dataset:
        assert {"trust", "origin"} < set(dataset.data_vars)
    np.testing.assert_array_equal(opened.fate, frame.fate)
    assert opened.spec == frame.spec
