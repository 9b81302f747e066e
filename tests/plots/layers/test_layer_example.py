"""The layer of the example in docs/extending.md is drawn, explained and stored like the page's layers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
import xarray as xr

from engine import CASES, EscapeMap, Execution, MapSpec, Plane, compute_map, open_result
from engine.foundations.arrays import read_only
from engine.jobs.job import Job, run_job
from engine.maps.map_jobs import map_job
from engine.maps.pixels import PixelAnalysis
from plots.layers import layer, map_images, table
from plots.layers.map_images import picture_pixels
from plots.layers.picture import ShownMap
from plots.pictures.palette import CLEAR, PAPER, rgba
from plots.texts import exports
from tests.extending import run_example

GIVEN: dict[str, Any] = {
    **{name: getattr(layer, name) for name in ("Code", "Layer", "Over", "Pixels", "occurring_entries")},
    **{one.__name__: one for one in (EscapeMap, IntEnum, Job, PixelAnalysis, dataclass, map_job, read_only)},
    "CLEAR": CLEAR, "ClassVar": ClassVar, "np": np, "__name__": __name__,
}  # fmt: skip


@pytest.fixture
def late(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The entry of the example, listed as the last layer."""
    entry = run_example("Example: add a layer", GIVEN)["LATE"]
    for module in (exports, map_images, table):
        monkeypatch.setattr(module, "LAYERS", {**table.LAYERS, entry.name: entry})
    return entry


def test_the_layer_of_the_example_is_drawn_explained_and_stored(late: Any, tmp_path: Path) -> None:
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (40, 40), t_max=1e3))
    found = run_job(late.job(frame.spec, {}), Execution(), {map_job(frame.spec): frame})
    analyses = {late.name: found}
    is_late = np.nan_to_num(frame.escape_time) > 10.0 * np.nanmedian(frame.escape_time)
    assert is_late.any()
    (colour,) = rgba(late.over.pixel_colours[1:])
    basins, crossings = (picture_pixels(frame, picture, PAPER, analyses)[::-1] for picture in ("basins", "crossings"))
    np.testing.assert_array_equal(np.all(basins == colour, axis=-1), is_late)
    assert not np.any(np.all(crossings == colour, axis=-1))
    assert [entry.label for entry in table.map_legend("basins", ShownMap.of(frame, PAPER, analyses)).over] == ["late"]
    (tmp_path / "map.nc").write_bytes(exports.netcdf_bytes(frame, analyses))
    with xr.open_dataset(tmp_path / "map.nc") as dataset:
        np.testing.assert_array_equal(dataset["late"], is_late)
    found.to_xarray().to_netcdf(tmp_path / "late.nc", engine="h5netcdf")
    np.testing.assert_array_equal(open_result(tmp_path / "late.nc").late, is_late)
