"""Results from files: NetCDF files and Zarr stores."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.extras import require_package
from engine.foundations.former_names import rename_stored
from engine.foundations.result import Result
from engine.foundations.validation import checks_types
from engine.maps.origin_fates import OriginFateMap
from engine.maps.regularity import RegularityMap
from engine.maps.result import EscapeMap
from engine.maps.stored_maps import read_map, read_spec
from engine.maps.trust import TrustMap
from engine.measures.basin_entropy import BasinEntropy
from engine.measures.uncertainty_exponent import UncertaintyExponent
from engine.propagation.classification import Outcomes
from engine.sweeps.sweep import Sweep
from engine.systems.outcomes import read_outcomes
from engine.systems.stored_potential import read_potential
from engine.trajectories.birkhoff_digits import BirkhoffDigits
from engine.trajectories.nearest_divergent_start import DivergentStart
from engine.trajectories.sampled_orbits import SampledOrbits
from engine.trajectories.separation import Separation
from engine.trajectories.trajectory import Orbit

if TYPE_CHECKING:
    import xarray as xr

_KINDS: dict[str, Any] = {
    kind.__name__: kind
    for kind in (
        EscapeMap, RegularityMap, TrustMap, OriginFateMap, Orbit, Outcomes, Separation, BirkhoffDigits, DivergentStart,
        BasinEntropy, UncertaintyExponent, Sweep, SampledOrbits,
    )
}  # fmt: skip
# Readers of results with a field that is neither a number nor an array nor a request of maps.
_READERS: dict[Any, Callable[[xr.Dataset], Result]] = {EscapeMap: read_map, Sweep: Sweep}
# Flags of finished energies in the stores of earlier versions, and the name of their curves: both are opened as plain datasets.
_FORMER_FLAGS, _FORMER_CURVES = "done", "Curves"
_ZARR = "zarr.json"


@checks_types(path=(str, os.PathLike))
def open_result(path: str | os.PathLike[str]) -> Any:
    """A result from a file.

    Parameters
    ----------
    path
        A NetCDF file, or the folder of a Zarr store, to which ``result.to_xarray()`` was written, or the store of a sweep.

    Returns
    -------
    An equal result: an `EscapeMap`, `RegularityMap`, `TrustMap`, `OriginFateMap`, `Orbit`, `SampledOrbits`, `Outcomes`,
    `Separation`, `BirkhoffDigits`, `DivergentStart`, `BasinEntropy`, `UncertaintyExponent`, or `Sweep`, which `compute_sweep`
    takes as `earlier`. A map has no integration state and cannot be resumed. The dataset of a sweep in a store is read on access;
    measures and analyses take one of its maps, ``sweep.dataset.sel(h=0.3)``. Sweeps and curves of earlier versions are opened as
    datasets.

    Raises
    ------
    OSError
        If there is no such file, or it cannot be read.
    ValueError
        If the file or folder holds no result, or one of another kind, which xarray can open.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_map, open_result
    >>> escapes = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (20, 20), t_max=100.0))
    >>> with TemporaryDirectory() as folder:
    ...     escapes.to_xarray().to_netcdf(f"{folder}/map.nc", engine="h5netcdf")
    ...     opened = open_result(f"{folder}/map.nc")
    >>> opened.spec == escapes.spec, bool((opened.fate == escapes.fate).all())
    (True, True)
    """
    # Slow to import, and seldom used.
    import xarray as xr

    if not Path(path).exists():
        raise FileNotFoundError(f"path={os.fspath(path)}: there is no such file or folder")
    if (Path(path) / _ZARR).exists():
        require_package("zarr", "files")
        stored: xr.Dataset = xr.open_zarr(path, chunks=None, consolidated=False)
        if _FORMER_FLAGS in stored:
            return stored.drop_vars(_FORMER_FLAGS)
        return _read(path, stored)
    if Path(path).is_dir():
        raise ValueError(
            f"path={os.fspath(path)}: is a folder without {_ZARR}; must be a NetCDF file or a Zarr store of format 3"
        )
    require_package("h5netcdf", "files")
    try:
        dataset = xr.open_dataset(path, engine="h5netcdf")
    except OSError as error:
        raise OSError(f"path={os.fspath(path)}: cannot be read as a NetCDF file: {error}") from error
    with dataset as opened:
        return _read(path, opened.load())


def _read(path: str | os.PathLike[str], dataset: xr.Dataset) -> Any:
    if dataset.attrs.get("result") == _FORMER_CURVES:
        return dataset
    kind = _KINDS.get(str(dataset.attrs.get("result")))
    if kind is None:
        held = dataset.attrs.get("result", "no result")
        raise ValueError(f"path={os.fspath(path)}: holds {held}; must hold one of {', '.join(_KINDS)}. xarray opens it")
    dataset = rename_stored(dataset)
    if kind in _READERS:
        return _READERS[kind](dataset)
    values = {each.name: _value(kind, each.name, dataset) for each in fields(kind)}
    found: Result = kind(**{name: value for name, value in values.items() if value is not None})
    return found


def _value(kind: Any, name: str, dataset: xr.Dataset) -> Any:
    """The value of a field; None for the default one."""
    if name == "spec":
        return read_spec(dataset)
    if name == "potential":
        return read_potential(dataset.attrs) if "terms" in dataset.attrs else None
    if name == "outcomes":
        return read_outcomes(dataset.attrs.get(name, "[]"))
    if name in ("x", "ordinate") and kind is OriginFateMap:
        return read_only(read_spec(dataset).pixel_centres()[name == "ordinate"])
    if name in dataset.variables and dataset[name].ndim:
        return read_only(np.array(dataset[name].values))
    found = dataset[name].values if name in dataset.variables else dataset.attrs.get(name)
    if found is None:
        return None
    number = np.asarray(found).item()
    if name == "complete":
        return bool(number)
    # Fates are numbers, as some of them are outcomes.
    return kind.codes[name](number) if name == "evidence" else number
