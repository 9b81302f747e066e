"""Results from files: NetCDF files and Zarr stores."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, replace
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any, get_args, get_type_hints, overload

from engine.foundations.extras import require_package
from engine.foundations.netcdf_files import read_netcdf
from engine.foundations.plug_ins import import_plug_ins
from engine.foundations.result import RecordedResult, Result
from engine.foundations.stored_fields import content_named, plain_attributes, read_field, with_present_names
from engine.foundations.validation import checked_path, checks_types
from engine.maps.pixels import PixelAnalysis
from engine.maps.result import EscapeMap, read_map
from engine.maps.spec import read_spec
from engine.sweeps.stored_metadata import METADATA_FILE, open_stored
from engine.sweeps.sweep import Sweep
from engine.systems.formulas.formula_parser import read_potential
from engine.systems.outcomes import read_outcomes
from engine.systems.potential import Potential
from engine.trajectories.sampled_orbits import SampledOrbits

if TYPE_CHECKING:
    import xarray as xr


def _read_sweep(dataset: xr.Dataset) -> Sweep:
    """Return a sweep; KeyError without the variables and attributes that all sweeps have."""
    found = Sweep(dataset)
    _ = found.describe(), found.outcomes
    return found


# Readers of results whose files do not contain the fields of a dataclass, by class.
_READERS: dict[Any, Callable[[xr.Dataset], Result]] = {
    EscapeMap: read_map,
    Sweep: _read_sweep,
    Potential: lambda dataset: read_potential(dataset.attrs),
}


@overload
def open_result(path: str | os.PathLike[str]) -> Any: ...
@overload
def open_result[Kind: Result](path: str | os.PathLike[str], kind: type[Kind]) -> Kind: ...
@checks_types(kind=type)
def open_result(path: str | os.PathLike[str], kind: type[Any] = Result) -> Any:
    """Open a result from a file.

    Parameters
    ----------
    path
        A NetCDF file that `Result.save` wrote, the folder of a Zarr store to which ``result.to_xarray()`` was written, or the
        store of a sweep.
    kind
        The class of the result, such as `EscapeMap`, by default any class; type checkers use it too.

    Returns
    -------
    A result identical to the written result, see `Result.identical`. A map of at most 2²⁰ pixels has no integration state and
    cannot be resumed. `compute_sweep` accepts a `Sweep` as `earlier`. The dataset of a sweep in a store is read on access;
    measures and analyses accept a map of the sweep, ``sweep.dataset.sel(h=0.3)``.

    Raises
    ------
    OSError
        If the file does not exist or cannot be read.
    ValueError
        If the file or folder contains no result, or a result of another class; xarray can open such a file.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from escape_explorer import CASES, EscapeMap, MapSpec, Plane, compute_map, open_result
    >>> escapes = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (20, 20), t_max=100.0))
    >>> with TemporaryDirectory() as folder:
    ...     escapes.save(f"{folder}/map.nc")
    ...     opened = open_result(f"{folder}/map.nc", EscapeMap)
    >>> opened.spec == escapes.spec, bool((opened.fate == escapes.fate).all())
    (True, True)
    """
    result = _open(checked_path("path", path))
    if kind is not Result and not isinstance(result, kind):
        raise ValueError(f"path={os.fspath(path)}: holds {type(result).__name__}; must hold {kind.__name__}")
    return result


def _open(path: Path) -> Any:
    """Return the result of a file or a Zarr store; an OSError names the path."""
    if not path.exists():
        raise FileNotFoundError(f"path={path}: there is no such file or folder")
    if (path / METADATA_FILE).exists():
        require_package("zarr", "files")
        return _read(path, open_stored(f"path={path}", path))
    if path.is_dir():
        raise ValueError(f"path={path}: is a folder without {METADATA_FILE}; must be a NetCDF file or a Zarr store of format 3")
    return _read(path, read_netcdf(path))


def _read(path: Path, dataset: xr.Dataset) -> Any:
    """Return the result of a dataset; a ValueError names the path."""
    name = str(dataset.attrs.get("result"))
    if name not in Result.kinds():
        # Other packages may define the class.
        import_plug_ins()
    kind = Result.kinds().get(name)
    if kind is None:
        content = dataset.attrs.get("result", "no result")
        raise ValueError(f"path={path}: holds {content}; must hold a result of this library. xarray opens it")
    with content_named(f"path={path}"):
        dataset = with_present_names(dataset)
        return _READERS[kind](dataset) if kind in _READERS else _read_fields(kind, dataset)


def _read_fields(kind: Any, dataset: xr.Dataset) -> Any:
    """Return a result from its fields; a field that the file does not contain has its default value, or is None without one."""
    hints = get_type_hints(kind)
    values = kind.read_parts(dataset)
    if kind is SampledOrbits:
        dataset = _with_times_of_each_orbit(dataset)
    elif issubclass(kind, PixelAnalysis):
        dataset = _with_axis_names(dataset)
    for field in fields(kind):
        stored_name = kind.held_as.get(field.name, field.name)
        if field.name in values:
            continue
        if field.name in _FIELD_READERS:
            values[field.name] = _FIELD_READERS[field.name](dataset)
        elif stored_name in dataset.variables:
            values[field.name] = read_field(hints[field.name], dataset[stored_name].values)
        elif stored_name in dataset.attrs:
            values[field.name] = read_field(hints[field.name], dataset.attrs[stored_name])
        elif field.default is MISSING and field.default_factory is MISSING:
            # Files omit fields that are None.
            if NoneType not in get_args(hints[field.name]):
                raise KeyError(field.name)
            values[field.name] = None
    result = kind(**values)
    return replace(result, made_by=_read_made_by(result, dataset)) if isinstance(result, RecordedResult) else result


def _read_made_by(result: RecordedResult, dataset: xr.Dataset) -> dict[str, Any]:
    """Return the attributes that say how a result was made, without its numbers."""
    result_names = {"result", "outcomes", *result.numbers(), *(field.name for field in fields(result))} - _NUMBERS_OF_REQUEST
    return {name: value for name, value in plain_attributes(dataset.attrs).items() if name not in result_names}


def _with_times_of_each_orbit(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset of sampled orbits with the times of each orbit, also if all orbits have common times."""
    if "t" not in dataset.dims:
        return dataset
    dataset = dataset.rename_dims(t="sample")
    return dataset.assign(t=dataset["t"].broadcast_like(dataset["x"]).transpose(*dataset["x"].dims))


def _with_axis_names(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset of an analysis of a map with its axes renamed to x and ordinate, as the fields are named."""
    ordinate, abscissa = next(variable.dims for variable in dataset.data_vars.values() if variable.ndim == 2)
    return dataset.rename({abscissa: "x", ordinate: "ordinate"})


# Readers of fields that are stored as several attributes or variables.
_FIELD_READERS: Mapping[str, Callable[[xr.Dataset], Any]] = {
    "spec": read_spec,
    "potential": lambda dataset: read_potential(dataset.attrs) if "terms" in dataset.attrs else None,
    "outcomes": lambda dataset: read_outcomes(dataset.attrs.get("outcomes", "[]")),
    "made_by": lambda dataset: {},
}
# Numbers of results that also say how the result was made; files contain them only once.
_NUMBERS_OF_REQUEST = {"potential", "energy", "t_max"}
