"""The metadata of a store, which a checksum protects, and the dataset of its complete values."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.foundations.stored_fields import content_named
from engine.sweeps.axes import axis_names

if TYPE_CHECKING:
    import xarray as xr

METADATA_FILE = "zarr.json"
"""Name of the file with the metadata of the group, or of an array."""

COUNT_ATTRIBUTE, ARRAYS_ATTRIBUTE, CHECKSUM_ATTRIBUTE = "finished", "arrays", "checksum"
"""Names of the attributes of the group with the number of complete values, the names of all arrays, and the checksum."""

OPTIONS: Mapping[str, Any] = {"consolidated": False, "zarr_format": 3}
"""Options of xarray for the format of the group."""


def metadata_checksum(folder: Path) -> str:
    """Return a checksum of the metadata of the group and its arrays, without the numbers of values, which change."""
    attributes = _read_attributes(folder)
    fixed = {name: value for name, value in attributes.items() if name not in (COUNT_ATTRIBUTE, CHECKSUM_ATTRIBUTE)}
    arrays = {name: {**metadata, "shape": metadata["shape"][1:]} for name, metadata in _read_arrays(folder, attributes).items()}
    return hashlib.sha256(json.dumps([fixed, arrays], sort_keys=True).encode()).hexdigest()


def _read_attributes(folder: Path) -> dict[str, Any]:
    """Return the attributes of the group; empty for a group of others without attributes."""
    content: dict[str, Any] = json.loads((folder / METADATA_FILE).read_bytes()).get("attributes", {})
    return content


def _read_arrays(folder: Path, attributes: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return the metadata of the arrays that exist, by name."""
    files = {name: folder / name / METADATA_FILE for name in attributes.get(ARRAYS_ATTRIBUTE, ())}
    return {name: json.loads(file.read_bytes()) for name, file in files.items() if file.exists()}


def check_metadata(label: str, folder: Path) -> None:
    """Raise a ValueError that begins with a label if the metadata are not those that were written.

    Stores of earlier versions have no checksum.
    """
    with content_named(label):
        checksum = _read_attributes(folder).get(CHECKSUM_ATTRIBUTE)
        is_changed = checksum is not None and checksum != metadata_checksum(folder)
    if is_changed:
        problem = f"its files {METADATA_FILE} have been changed or damaged"
        raise ValueError(f"{label}: {problem}; restore them, or delete the folder to compute everything again")


def without_values(attributes: Mapping[str, Any]) -> xr.Dataset:
    """Return the dataset of a request before its first value."""
    # This import is slow.
    import xarray as xr

    return xr.Dataset(coords={name: np.zeros(0) for name in axis_names(attributes)}, attrs=attributes)


def open_stored(label: str, folder: Path) -> xr.Dataset:
    """Return the complete values of a store as `read_stored` does, or raise a ValueError that begins with a label."""
    check_metadata(label, folder)
    with content_named(label):
        attributes = _read_attributes(folder)
        lengths = _count_values(folder, attributes) if COUNT_ATTRIBUTE in attributes else set()
    if len(lengths) > 1:
        problem = "a value is being added, or a run was killed while it added one"
        raise ValueError(f"{label}: {problem}; read it later, or continue the computation")
    with content_named(label):
        return read_stored(folder)


def _count_values(folder: Path, attributes: Mapping[str, Any]) -> set[int]:
    """Return the numbers of values, complete or not, of the arrays of a store."""
    axis = axis_names(attributes)[0]
    return {array["shape"][0] for array in _read_arrays(folder, attributes).values() if axis in array["dimension_names"]}


def read_stored(folder: Path) -> xr.Dataset:
    """Return the complete values of a store in ascending order. Arrays are read from the disk on access.

    Other groups, which have no number of complete values, are returned as they are.
    """
    # This import is slow.
    import xarray as xr

    attributes = _read_attributes(folder)
    finished = attributes.get(COUNT_ATTRIBUTE)
    state = (COUNT_ATTRIBUTE, ARRAYS_ATTRIBUTE, CHECKSUM_ATTRIBUTE)
    request = {name: value for name, value in attributes.items() if name not in state}
    if finished == 0:
        return without_values(request)
    dataset: xr.Dataset = xr.open_zarr(folder, chunks=None, **OPTIONS)
    if finished is None:
        return dataset
    axis = axis_names(request)[0]
    complete = dataset.isel({axis: slice(finished)})
    complete.attrs = request
    values = complete[axis].values
    if np.isnan(values).any():
        raise ValueError(f"values of {axis} are missing; the same computation with this store computes them again")
    return complete if np.all(np.diff(values) > 0.0) else complete.sortby(axis)
