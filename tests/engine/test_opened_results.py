"""Results read from files are equal to the written results."""

from __future__ import annotations

import errno
import functools
import inspect
import os
import re
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import dask
import dask.array
import numpy as np
import pytest
import xarray as xr

import engine
from engine import (
    CASES,
    POTENTIALS,
    Coordinate,
    Direction,
    EscapeMap,
    MapSpec,
    ParameterAxis,
    Plane,
    Potential,
    Regularity,
    Result,
    Slice,
    SweepSpec,
    System,
    classify_orbits,
    compute_basin_entropy,
    compute_chaotic_share,
    compute_exit_matching,
    compute_flux,
    compute_islands,
    compute_map,
    compute_regularity,
    compute_statistics,
    compute_sweep,
    compute_trust,
    compute_wada_test,
    find_lyapunov_orbits,
    find_stable_manifolds,
    fit_decay_laws,
    integrate_orbit,
    judge_orbit,
    open_result,
    parse_formula,
    review_potential,
    sample_orbits,
    sample_starts,
)
from engine.results import Sweep
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits
from tests.results import result_of

C = Coordinate
III, STATE = CASES["III"], (0.1, 0.0, 0.05, 0.6)
SPEC = MapSpec(III, Plane.X_PX, 0.36, (12, 10), t_max=200.0)
TYPED = parse_formula("½(x² + 1.21y²) − 0.123456789012345x²y − 0.1a x³", parameters={"a": 0.7})

SPECS = {
    "paper": SPEC,
    "window": replace(SPEC, window=(-0.3, 0.1, -0.2, 0.4)),
    "backward": replace(SPEC, backward=True, use_evidence=False),
    "energies": MapSpec(III, Plane.X_H, (0.2, 0.5), (8, 8), t_max=50.0),
    "tangential": MapSpec(POTENTIALS["HH"], Plane.TANGENTIAL, 0.2, (8, 8), t_max=50.0),
    "held": MapSpec(TYPED, Slice(C.X, C.PX, C.PY, -1, ((C.Y, 0.1),)), 0.5, (8, 8), t_max=50.0),
    "oblique": MapSpec(III, Slice(Direction("u", x=1.0, py=0.3), C.Y), 0.36, (8, 8), t_max=50.0),
    "parameter": MapSpec(CASES["I"], Slice(C.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))), 0.2, (6, 6), t_max=50.0),
}

# Results of `tests.results` that are tested unchanged. Variants of the others are in `RESULTS`.
SHARED = (
    "trust", "origins", "descriptors", "separation", "divergent start", "entropy", "exponent", "Wada test",
    "Lyapunov orbit", "manifolds", "verdict", "review", "decay laws", "returns", "returns of orbits",
    "periodic orbit", "periodic orbits", "family", "family along a parameter", "symmetric families", "threshold",
)  # fmt: skip
RESULTS: dict[str, Callable[[], Result | None]] = {
    **{name: functools.partial(result_of, name) for name in SHARED},
    "outcomes": lambda: classify_orbits(III, 0.36, sample_starts(III, 0.36, 20, rng=0), t_max=50.0),
    "regularity": lambda: compute_regularity(compute_map(replace(SPEC, t_max=1200.0))),
    "escaping orbit": lambda: integrate_orbit(TYPED, STATE, t_max=50.0),
    "bounded orbit": lambda: integrate_orbit(III, (0.05, 0.0, 0.0, 0.1), t_max=50.0),
    "sampled orbits": lambda: sample_orbits(III, sample_starts(III, 0.36, 5, rng=0), [0.0, 2.0, 9.0]),
    "sampled orbits at own times": lambda: sample_orbits(III, sample_starts(III, 0.36, 2, rng=0), [[0.0, 2.0], [1.0, 9.0]]),
    "digits": lambda: compute_birkhoff_digits(CASES["I"], (0.1, 0.0, 0.05, 0.3), 2e3),
    "Wada test of an array": lambda: compute_wada_test(np.zeros((3, 3), int)),
    "statistics": lambda: compute_statistics(compute_map(SPEC), (-0.3, 0.3, -0.3, 0.3)),
    "statistics without escapes": lambda: compute_statistics(compute_map(replace(SPEC, energy=0.1))),
    "no decay laws": lambda: fit_decay_laws(compute_map(SPEC)),
    "islands": lambda: compute_islands(compute_map(SPEC)),
    "chaotic share": lambda: compute_chaotic_share([Regularity.CHAOTIC, Regularity.REGULAR]),
    "exit matching": lambda: compute_exit_matching(
        [1, 2] * 10, classify_orbits(III, 0.36, sample_starts(III, 0.36, 20, rng=0), t_max=50.0)
    ),
    "flux": lambda: compute_flux(III, 0.36),
    "no flux": lambda: compute_flux(III, 0.1),
    "potential": lambda: TYPED,
    "review with a refusal": lambda: review_potential(parse_formula("x⁴ + y⁴")),
    "Lyapunov orbit of a rotating system": lambda: find_lyapunov_orbits(POTENTIALS["Hill"], -2.1)[0],
    "no manifolds": lambda: find_stable_manifolds(CASES["I"], 0.1, images=1),
    "verdict on a bounded orbit": lambda: judge_orbit(integrate_orbit(III, (0.05, 0.0, 0.0, 0.1), t_max=50.0)),
}

OF_ARRAYS = {"Wada test of an array", "chaotic share"}
PARAMETER = ParameterAxis("epsilon", 0.5, 2.0, System("I"))
SHARES = ("shares", "islands")
SWEEPS = {
    "energy": SweepSpec(III, Plane.X_PX, (0.3, 0.36), (12, 12), t_max=100.0, measures=SHARES, refine=1),
    "one value": SweepSpec(TYPED, Slice(C.X, C.PX, C.PY, -1), (0.5,), (8, 8), t_max=50.0, measures=SHARES),
    "parameter": SweepSpec(CASES["I"], Plane.X_Y, (0.8, 1.0), (10, 10), t_max=50.0, measures=SHARES, along=PARAMETER, energy=0.2),
}


def to_netcdf(result: Result, folder: Path) -> Path:
    result.save(folder / "result.nc")
    return folder / "result.nc"


def to_zarr(result: Result, folder: Path) -> Path:
    result.to_xarray().to_zarr(folder / "result.zarr", consolidated=False, zarr_format=3)
    return folder / "result.zarr"


WRITERS: dict[str, Callable[[Result, Path], Path]] = {"NetCDF": to_netcdf, "Zarr": to_zarr}


def assert_equal(found: Any, wanted: Any) -> None:
    """Check equality to the last bit, without the integration state and the system, which files do not contain."""
    assert type(found) is type(wanted)
    for field in fields(wanted):
        one, other = getattr(found, field.name), getattr(wanted, field.name)
        if isinstance(other, np.ndarray):
            np.testing.assert_array_equal(one, other, err_msg=field.name)
            assert one.dtype == other.dtype
            assert not one.flags.writeable
        elif field.name == "arcs":
            for each, arc in zip(one, other, strict=True):
                assert_equal(each, arc)
        elif field.name not in ("batch", "made_by", "system"):
            assert type(one) is type(other), field.name
            assert one == other or (one != one and other != other), field.name


@pytest.mark.parametrize("how", WRITERS)
@pytest.mark.parametrize("name", SPECS)
def test_a_map_read_from_a_file_is_equal(name: str, how: str, tmp_path: Path) -> None:
    wanted = compute_map(SPECS[name])
    found = open_result(str(WRITERS[how](wanted, tmp_path)))
    assert_equal(found, wanted)
    assert found.fractions() == wanted.fractions()
    assert found.spec.potential.name == wanted.spec.potential.name


@functools.cache
def computed(name: str) -> Result:
    result = RESULTS[name]()
    assert result is not None
    return result


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_read_from_a_file_is_equal_and_can_be_written_again(name: str, tmp_path: Path) -> None:
    wanted = computed(name)
    found = open_result(to_netcdf(wanted, tmp_path))
    assert_equal(found, wanted)
    assert found.identical(wanted)


FORMER_DIMENSIONS = {
    "statistics": {"escape": "escape_times_entry_0"},
    "Lyapunov orbit": {"column": "curve_entry_0", "component": "velocity_entry_0"},
}


@pytest.mark.parametrize("name", FORMER_DIMENSIONS)
def test_files_with_former_names_of_dimensions_are_read(name: str, tmp_path: Path) -> None:
    dataset = computed(name).to_xarray()
    dataset.rename_dims(FORMER_DIMENSIONS[name]).to_netcdf(tmp_path / "former.nc", engine="h5netcdf")
    assert open_result(tmp_path / "former.nc").identical(computed(name))


@pytest.mark.parametrize("name", RESULTS)
def test_dimensions_in_files_are_named_after_what_they_count(name: str) -> None:
    sizes = computed(name).to_xarray().sizes
    assert [str(dimension) for dimension in sizes if re.search(r"\d|entry|dim", str(dimension))] == []


def test_returns_in_files_have_the_dimensions_of_the_arrays() -> None:
    returns = computed("returns of orbits").to_xarray()
    assert returns["states"].dims == ("return", "orbit", "coordinate")
    assert returns["time"].dims == ("return", "orbit")
    assert returns["fate"].dims == ("orbit",)


def test_results_that_differ_in_a_number_or_in_their_class_are_not_identical() -> None:
    one = computed("outcomes")
    assert one.identical(one)
    assert not one.identical(replace(one, t_max=49.0))  # type: ignore[call-arg]
    assert not one.identical(computed("sampled orbits"))


@pytest.mark.parametrize("name", RESULTS)
def test_files_of_netcdf_3_are_read_as_the_base_installation_writes_them(name: str, tmp_path: Path) -> None:
    wanted = computed(name)
    wanted.to_xarray().to_netcdf(tmp_path / "result.nc", engine="scipy")
    found = open_result(tmp_path / "result.nc")
    assert type(found) is type(wanted)
    xr.testing.assert_equal(found.to_xarray(), wanted.to_xarray())


def test_every_kind_of_result_is_tested() -> None:
    kinds = {type(computed(name)) for name in RESULTS} | {EscapeMap, Sweep}
    of_engine = (getattr(package, name) for package in (engine, engine.results) for name in package.__all__)
    results = {each for each in of_engine if inspect.isclass(each) and issubclass(each, Result)} - {Result}
    assert {kind.__name__ for kind in results - kinds} == set()


@pytest.mark.parametrize("name", [name for name in RESULTS if name not in OF_ARRAYS])
def test_a_file_says_with_which_version_and_of_which_potential_it_was_made(name: str) -> None:
    attributes = computed(name).to_xarray().attrs
    wanted = ["version", "potential", "terms", "rotation", "centres", "escape_radius", "origin"]
    assert [each for each in wanted if each not in attributes] == []


@pytest.mark.parametrize("name", ["Wada test", "statistics", "decay laws", "entropy", "exponent", "outcomes"])
def test_a_file_of_a_measure_says_its_energy_and_its_time(name: str) -> None:
    attributes = computed(name).to_xarray().attrs
    assert (attributes["energy"], attributes["t_max"]) == (0.36, 50.0 if name == "outcomes" else 200.0)
    assert "tolerance" in attributes["integrator"]


def test_common_times_are_a_dimension() -> None:
    dataset = computed("sampled orbits").to_xarray()
    assert dict(dataset.sizes) == {"orbit": 5, "t": 3}
    np.testing.assert_array_equal(dataset.sel(t=2.0)["x"], computed("sampled orbits").x[:, 1])  # type: ignore[attr-defined]


@pytest.mark.parametrize("how", WRITERS)
@pytest.mark.parametrize("name", SWEEPS)
def test_a_sweep_read_from_a_file_is_equal_and_continues(name: str, how: str, tmp_path: Path) -> None:
    wanted = compute_sweep(SWEEPS[name])
    found = open_result(WRITERS[how](wanted, tmp_path))
    xr.testing.assert_equal(found.dataset, wanted.dataset)
    assert (found.outcomes, found.symbol, found.complete) == (wanted.outcomes, wanted.symbol, True)
    more = replace(SWEEPS[name], values=(*SWEEPS[name].values, SWEEPS[name].values[-1] * 1.1), refine=0)
    seen: list[int] = []
    compute_sweep(more, earlier=found, on_frame=lambda sweep: seen.append(sweep.values.size))
    assert seen == [len(more.values)]


SWEEP = SweepSpec(III, Plane.X_PX, (0.3, 0.36, 0.5), (30, 30), t_max=200.0)


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sweeps") / "maps.zarr"
    compute_sweep(SWEEP, path)
    return path


def test_a_file_of_an_unwanted_kind_is_refused(tmp_path: Path) -> None:
    CASES["I"].save(tmp_path / "case.nc")
    assert open_result(tmp_path / "case.nc", Potential) == CASES["I"]
    with pytest.raises(ValueError, match=r"case\.nc: holds Potential; must hold EscapeMap$"):
        open_result(tmp_path / "case.nc", EscapeMap)


def test_a_sweep_read_from_a_store_is_equal(store: Path) -> None:
    xr.testing.assert_identical(open_result(store).dataset, compute_sweep(SWEEP, store).dataset)


@pytest.mark.parametrize("h", [0.3, 0.36, 0.5])
def test_measures_and_analyses_take_a_map_of_a_sweep(h: float, store: Path) -> None:
    maps = open_result(store).dataset
    one, wanted = maps.sel(h=h), compute_map(MapSpec(III, Plane.X_PX, h, (30, 30), tuple(maps.attrs["window"]), 200.0))
    assert compute_basin_entropy(one) == compute_basin_entropy(wanted)
    assert compute_wada_test(one).describe() == compute_wada_test(wanted).describe()
    assert compute_statistics(one).shares == compute_statistics(wanted).shares
    assert fit_decay_laws(one).describe() == fit_decay_laws(wanted).describe()
    assert_equal(compute_regularity(one), compute_regularity(wanted))
    assert_equal(compute_trust(one), compute_trust(wanted))


def test_analyses_refuse_a_map_of_a_sweep_along_a_parameter_whose_fates_have_other_numbers() -> None:
    along = ParameterAxis("epsilon", 0.5, 2.0, System("I"))
    window = (-0.4, 0.4, -0.4, 0.4)
    sweep = compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, [0.8], (6, 5), window, 100.0, along=along, energy=0.3))
    one = sweep.dataset.isel(epsilon=0)
    assert compute_statistics(one).decided == 30
    with pytest.raises(ValueError, match="sweep along epsilon"):
        compute_trust(one)


def test_a_dataset_of_several_maps_is_refused(store: Path) -> None:
    with pytest.raises(ValueError, match=r"labels: a dataset of several maps; must be one of them, such as dataset.sel"):
        compute_basin_entropy(open_result(store).dataset)


def test_an_opened_map_cannot_be_resumed_but_says_so(tmp_path: Path) -> None:
    opened = open_result(to_netcdf(compute_map(SPEC), tmp_path))
    assert isinstance(opened, EscapeMap)
    with pytest.raises(ValueError, match="resume"):
        compute_map(replace(SPEC, t_max=400.0), resume=opened)


def test_a_potential_whose_terms_are_not_understood_is_refused(tmp_path: Path) -> None:
    dataset = compute_map(SPEC).to_xarray().assign_attrs(terms="0.5 x^2 + something")
    dataset.to_netcdf(tmp_path / "result.nc", engine="h5netcdf")
    with pytest.raises(ValueError, match="formula"):
        open_result(tmp_path / "result.nc")


def test_a_file_of_another_result_is_named(tmp_path: Path) -> None:
    xr.Dataset({"a": 1}, attrs={"result": "Painting"}).to_netcdf(tmp_path / "painting.nc")
    with pytest.raises(ValueError, match="holds Painting; must hold"):
        open_result(tmp_path / "painting.nc")
    xr.Dataset({"a": 1}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    with pytest.raises(ValueError, match="holds no result"):
        open_result(tmp_path / "other.nc")


class Failing(Result):
    """A result whose numbers cannot be computed while the file is written."""

    def to_xarray(self) -> xr.Dataset:
        def fail() -> None:
            raise ArithmeticError

        return xr.Dataset({"number": ("x", dask.array.from_delayed(dask.delayed(fail)(), (3,), float))})


def test_a_file_with_damaged_data_is_refused_and_named(tmp_path: Path) -> None:
    escape_map = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.24, (40, 40), t_max=100.0))
    file = tmp_path / "map.nc"
    escape_map.save(file)
    content = bytearray(file.read_bytes())
    some_times = escape_map.escape_time[20, 10:18].tobytes()
    place = content.find(some_times)
    content[place : place + len(some_times)] = bytes(len(some_times))
    file.write_bytes(content)
    assert place > 0
    with pytest.raises(OSError, match=r"map\.nc: cannot be read as a NetCDF file: is damaged; restore it"):
        open_result(file)


def test_a_result_that_cannot_be_written_leaves_the_earlier_file(tmp_path: Path) -> None:
    computed("potential").save(tmp_path / "result.nc")
    earlier = (tmp_path / "result.nc").read_bytes()
    with pytest.raises(ArithmeticError):
        Failing().save(tmp_path / "result.nc")
    assert [path.name for path in tmp_path.iterdir()] == ["result.nc"]
    assert (tmp_path / "result.nc").read_bytes() == earlier


def test_a_result_that_cannot_be_written_names_its_file(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as raised:
        computed("potential").save(tmp_path / "missing" / "result.nc")
    assert raised.value.filename == str(tmp_path / "missing" / "result.nc")
    assert raised.value.strerror == os.strerror(errno.ENOENT)
