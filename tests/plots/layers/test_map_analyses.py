"""The file of a map has the variables of its layers, and opens as the map."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from engine import CASES, MapSpec, Plane, compute_map, compute_origin_fates, compute_trust, open_result
from plots.layers.map_analyses import MapAnalyses
from plots.layers.table import LAYERS
from plots.texts.exports import netcdf_bytes


def test_a_map_with_results_of_layers_opens_as_the_map(tmp_path: Path) -> None:
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (20, 20), t_max=200.0))
    analyses = MapAnalyses({"origins": compute_origin_fates(frame.spec), "trust": compute_trust(frame)})
    (tmp_path / "map.nc").write_bytes(netcdf_bytes(frame, analyses))
    opened = open_result(tmp_path / "map.nc")
    np.testing.assert_array_equal(opened.fate, frame.fate)
    assert opened.spec == frame.spec
    assert {"trust", "origin"} < set(analyses.add_to(frame.to_xarray()).data_vars)


def test_results_have_the_order_of_the_layers_and_can_be_removed() -> None:
    analyses = MapAnalyses({"origins": 1, "judge": 2})
    assert list(analyses) == [name for name in LAYERS if name in ("judge", "origins")]
    assert analyses.with_result("judge", None) == MapAnalyses({"origins": 1})
