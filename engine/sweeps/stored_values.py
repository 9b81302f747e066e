"""Which values of a store are complete. The data of a value that is missing never look like a result."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.propagation.fates import Fate

if TYPE_CHECKING:
    import xarray as xr
    import zarr


def encodings(dataset: xr.Dataset) -> dict[str, dict[str, Any]]:
    """Return the encodings of arrays in a store: chunks have checksums, and missing data never look like a result.

    Missing integers are `Fate.NOT_COMPUTED`, which no integer of a sweep can be. Missing floats are NaN by default.
    """
    # The import is slow.
    from zarr.codecs import Crc32cCodec, ZstdCodec

    checked = {"compressors": (ZstdCodec(), Crc32cCodec())}
    absent = {"fill_value": int(Fate.NOT_COMPUTED)}
    return {
        str(name): checked | (absent if np.issubdtype(array.dtype, np.integer) else {})
        for name, array in dataset.variables.items()
    }


def has_axis(array: zarr.Array[Any], axis: str) -> bool:
    """Return whether an array has a dimension of this name."""
    return axis in (getattr(array.metadata, "dimension_names", None) or ())


def count_complete(folder: Path, arrays: Mapping[str, zarr.Array[Any]], axis: str, finished: int) -> int:
    """Return the number of values before the first value with data that are missing or cannot be decoded.

    Parameters
    ----------
    folder
        The folder of the group.
    arrays
        The arrays of the group. Those with the axis have it as first dimension, with one chunk for each value.
    axis
        Name of the dimension of the values.
    finished
        Number of values that should be complete.
    """
    complete = finished
    for name, array in arrays.items():
        data = folder / name / "c"
        if not has_axis(array, axis):
            complete = complete if _is_complete(data, array, ...) else 0
            continue
        damaged = (k for k in range(complete) if not _is_complete(data / str(k), array, k))
        complete = next(damaged, complete)
    return complete


def _is_complete(data: Path, array: zarr.Array[Any], selection: Any) -> bool:
    """Return whether all files of the selected chunks exist in a file or folder, and their content can be decoded."""
    shape = array.shape if selection is ... else array.shape[1:]
    chunks = array.chunks if selection is ... else array.chunks[1:]
    expected = math.prod(math.ceil(size / length) for size, length in zip(shape, chunks, strict=True))
    files = 1 if data.is_file() else sum(file.is_file() for file in data.rglob("*"))
    if files < expected:
        return False
    try:
        array[selection]
    except Exception:
        # Each codec has errors of its own.
        return False
    return True
