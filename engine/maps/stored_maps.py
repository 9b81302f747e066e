"""Maps from their datasets: in memory, from files, and from the stores of sweeps."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.former_names import rename_stored
from engine.foundations.validation import short_repr
from engine.maps.result import PIXEL_ARRAYS, EscapeMap
from engine.maps.spec import MapSpec
from engine.propagation.fates import Fate
from engine.slices.slice_text import read_slice
from engine.systems.formulas.stored_potential import read_potential
from engine.systems.system import System

if TYPE_CHECKING:
    import xarray as xr

type MapLike = EscapeMap | xr.Dataset
"""A map as measures and analyses take it: an `EscapeMap`, or the dataset of one, such as one of the maps of a sweep."""


def as_map(name: str, value: Any) -> EscapeMap:
    """A map, given as one or as its dataset: `EscapeMap.to_xarray`, a file, or ``dataset.sel(h=0.3)`` of a sweep.

    Raises
    ------
    ValueError
        If it is neither, or a dataset of several maps; `name` is the parameter.
    """
    if isinstance(value, EscapeMap):
        return value
    if hasattr(value, "data_vars"):
        value = rename_stored(value)
    missing = [each for each in PIXEL_ARRAYS if each != "started" and each not in getattr(value, "data_vars", ())]
    if "fate" in missing:
        raise ValueError(f"{name}={short_repr(value)}: must be an EscapeMap, or a dataset of one")
    if missing:
        raise ValueError(f"{name}: a dataset of a map without {', '.join(missing)}; must have all arrays of the map")
    if value["fate"].ndim != len(("rows", "columns")):
        raise ValueError(f"{name}: a dataset of several maps; must be one of them, such as dataset.sel(h=…)")
    return read_map(value)


def read_map(dataset: xr.Dataset) -> EscapeMap:
    """The map of a dataset. It has no integration state, so that it cannot be resumed."""
    spec = read_spec(dataset)
    abscissa, ordinate = spec.plane.axis_names
    arrays: dict[str, Any] = {name: read_only(np.array(dataset[name].values)) for name in PIXEL_ARRAYS if name != "started"}
    started = arrays["fate"] != Fate.NOT_COMPUTED
    return EscapeMap(
        spec=spec, x=read_only(np.array(dataset[abscissa].values)), ordinate=read_only(np.array(dataset[ordinate].values)),
        stride=1, horizon=spec.t_max, progress=float(started.mean()), complete=bool(started.all()), started=read_only(started),
        rounded_share=float(dataset.attrs["rounded_share"]) if "rounded_share" in dataset.attrs else None, **arrays,
    )  # fmt: skip


def read_spec(dataset: xr.Dataset) -> MapSpec:
    """The request of a map, from the attributes of its dataset; the energy of one map of a sweep is its coordinate h."""
    found = dataset.attrs
    if found.get("along"):
        raise ValueError(
            f"dataset: is of a sweep along {found['axis']}, whose fates have the numbers of the sweep; must be a map of "
            "compute_map, or one of a sweep over energies"
        )
    try:
        chosen = json.loads(found["system"])
        system = System(**chosen) if chosen else System("I")
        plane = read_slice(str(found["axes"]), str(found["fix"]), system)
        energy = found["energy"] if "energy" in found else float(dataset["h"].values)
        window = None if found["default_window"] else tuple(float(edge) for edge in found["window"])
        columns, rows = map(int, found["resolution"])
    except KeyError as error:
        raise ValueError(f"dataset: has no attribute {error}; must be one of a map, written by this version") from None
    return MapSpec(
        read_potential(found), plane, _plain(energy), (columns, rows), window,  # type: ignore[arg-type]
        float(found["t_max"]), use_evidence=bool(found["use_evidence"]), backward=bool(found["backward"]),
    )  # fmt: skip


def _plain(energy: Any) -> Any:
    """An energy, or a pair of them, as a request has it."""
    return tuple(map(float, energy)) if np.ndim(energy) else float(energy)
