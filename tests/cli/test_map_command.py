"""Command ``map``: its files contain the results of the engine."""

from __future__ import annotations

import csv
import json
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from PIL import Image

from engine import (
    CASES,
    Coordinate,
    MapSpec,
    ParameterAxis,
    Plane,
    Slice,
    System,
    compute_map,
    compute_origin_fates,
    compute_regularity,
    compute_trust,
    find_stable_manifolds,
    find_symmetric_families,
)
from plots.pictures.palette import COLOUR_BLIND_SAFE
from plots.printed.figure_files import map_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from tests.cli.conftest import Run

C = Coordinate

REQUESTS = {
    "window": (
        ("II", "--energy", 0.18, "--window", -0.3, 0.9, -0.5, 0.4, "--resolution", "12x9", "--t-max", 200),
        MapSpec(CASES["II"], Plane.X_PX, 0.18, (12, 9), (-0.3, 0.9, -0.5, 0.4), 200.0),  # type: ignore[arg-type]
    ),
    "(x, y) without evidence": (
        ("III", "--energy", 0.3, "--plane", "x_y", "--resolution", 10, "--t-max", 300, "--no-evidence", "--threads", 1),
        MapSpec(CASES["III"], Plane.X_Y, 0.3, (10, 10), t_max=300.0, use_evidence=False),
    ),
    "(x, h)": (
        ("I", "--energies", 0.13, 0.4, "--plane", "x_h", "--resolution", 8, "--t-max", 100),
        MapSpec(CASES["I"], Plane.X_H, (0.13, 0.4), (8, 8), t_max=100.0),
    ),
    "(y, py) at another x": (
        ("II", "--energy", 0.2, "--axes", "y,py", "--fix", "x=0.1", "--fix", "px=-", "--resolution", 8, "--t-max", 100),
        MapSpec(CASES["II"], Slice(C.Y, C.PY, C.PX, -1, ((C.X, 0.1),)), 0.2, (8, 8), t_max=100.0),
    ),
    "along a parameter": (
        ("I", "--energy", 0.2, "--axes", "x,eps=0.5:2", "--fix", "px=0", "--resolution", 8, "--t-max", 100),
        MapSpec(CASES["I"], Slice(C.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))), 0.2, (8, 8), t_max=100.0),
    ),
    "backward": (
        ("I", "--energy", 0.2, "--resolution", 8, "--t-max", 100, "--backward"),
        MapSpec(CASES["I"], Plane.X_PX, 0.2, (8, 8), t_max=100.0, backward=True),
    ),
}
BOUNDED = ("I", "--energy", 0.13, "--resolution", 9, "--t-max", 1000)
BOUNDED_SPEC = MapSpec(CASES["I"], Plane.X_PX, 0.13, (9, 9), t_max=1000.0)


def load(path: Path) -> xr.Dataset:
    with xr.open_dataset(path, engine="h5netcdf") as dataset:
        return dataset.load()


@pytest.mark.parametrize("name", REQUESTS)
def test_netcdf_equals_the_engine_result(name: str, run: Run, tmp_path: Path) -> None:
    arguments, spec = REQUESTS[name]
    assert run("map", *arguments, "--output", tmp_path / "map", "--format", "nc")[0] == 0
    found, wanted = load(tmp_path / "map.nc"), compute_map(spec).to_xarray()
    for variable in wanted.variables:
        np.testing.assert_array_equal(found[variable], wanted[variable])
    assert found.attrs["potential"] == spec.potential.name


def test_netcdf_contains_the_follow_up_analyses(run: Run, tmp_path: Path) -> None:
    assert run("map", *BOUNDED, "--judge", "--trust", "--origins", "--format", "nc", "--output", tmp_path / "map")[0] == 0
    found, frame = load(tmp_path / "map.nc"), compute_map(BOUNDED_SPEC)
    np.testing.assert_array_equal(found["character"], compute_regularity(frame).character)
    np.testing.assert_array_equal(found["trust"], compute_trust(frame).trust)
    np.testing.assert_array_equal(found["origin"], compute_origin_fates(BOUNDED_SPEC).origin)


def test_along_h_the_layer_of_periodic_orbits_writes_their_families(run: Run, tmp_path: Path) -> None:
    arguments = ("map", "III", "--plane", "x_h", "--energies", 0.1, 0.3, "--resolution", 5, "--t-max", 50, "--periodic", 1)
    code, printed, _ = run(*arguments, "--format", "nc", "--output", tmp_path / "map")
    assert code == 0
    with (tmp_path / "map-periodic.csv").open() as file:
        rows = list(csv.DictReader(file))
    found = find_symmetric_families(MapSpec(CASES["III"], Plane.X_H, (0.1, 0.3), t_max=50.0), 1)
    assert len(found) >= 3
    for column in ("curve", "returns", "abscissa", "ordinate", "period", "stability_index"):
        assert [float(row[column]) for row in rows] == getattr(found, column).tolist()
    assert found.describe() in " ".join(printed.split())


def test_manifolds_csv_has_full_precision(run: Run, tmp_path: Path) -> None:
    arguments = ("map", "I", "--energy", 0.19, "--resolution", 5, "--t-max", 50, "--manifolds", 1, "--format", "nc")
    assert run(*arguments, "--output", tmp_path / "map")[0] == 0
    with (tmp_path / "map-manifolds.csv").open() as file:
        rows = list(csv.DictReader(file))
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.19)
    arcs = find_stable_manifolds(CASES["I"], 0.19, images=1, window=spec.window).arcs
    for column, name in (("x", "x"), ("px", "ordinate")):
        assert [float(row[column]) for row in rows] == np.concatenate([getattr(arc, name) for arc in arcs]).tolist()
    assert [int(row["arc"]) for row in rows] == [n for n, arc in enumerate(arcs, 1) for _ in range(arc.x.size)]


def test_png_equals_the_download_of_the_page(run: Run, tmp_path: Path) -> None:
    pictures = ("--picture", "times", "--picture", "characters", "--format", "png")
    style = ("--width", 9, "--dpi", 100, "--palette", "safe")
    assert run("map", *BOUNDED, *pictures, *style, "--output", tmp_path / "map")[0] == 0
    frame = compute_map(BOUNDED_SPEC)
    analyses = {"judge": compute_regularity(frame)}
    wanted = map_figure_bytes(
        frame, ("times", "characters"), COLOUR_BLIND_SAFE, FigureFormat.PNG, FigureStyle(9.0, 100.0), analyses=analyses
    )
    with Image.open(tmp_path / "map.png") as found, Image.open(BytesIO(wanted)) as expected:
        np.testing.assert_array_equal(np.asarray(found), np.asarray(expected))


def test_json_contains_shares_and_files(run: Run, tmp_path: Path) -> None:
    arguments = ("map", "II", "--energy", 0.5, "--resolution", 9, "--t-max", 100, "--window", -1, 2, -1, 1, "--format", "nc")
    code, out, err = run(*arguments, "--count-outside", "--json", "--output", tmp_path / "map")
    answer = json.loads(out)
    spec = MapSpec(CASES["II"], Plane.X_PX, 0.5, (9, 9), (-1.0, 2.0, -1.0, 1.0), 100.0)  # type: ignore[arg-type]
    wanted = compute_map(spec).fractions(count_outside=True)
    assert (code, err) == (0, "")
    assert answer["files"] == [str(tmp_path / "map.nc")]
    assert [answer["shares"][f"exit {k}"] for k in (1, 2, 3)] == [wanted[k] for k in (1, 2, 3)]


def test_by_default_files_are_named_after_the_map_and_the_table_is_printed_alone(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, err = run("map", *BOUNDED)
    assert (code, err) == (0, "")
    share = compute_map(BOUNDED_SPEC).fractions()[0]
    assert f"{100 * share:.2f} %" in next(line for line in out.splitlines() if "bounded" in line)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["escapes-I-x_px-h0.13-t1000.nc", "escapes-I-x_px-h0.13-t1000.png"]
