"""The store of a sweep: one Zarr group on disk, filled row block by row block."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from engine.maps.result import EscapeMap
from engine.results.extras import require_package

if TYPE_CHECKING:
    import xarray as xr

DONE = "done"
"""Array (h,) of bool: the finished energies. An element is written after all other arrays of its energy."""

_FORMAT: Final = 3
# Name of the temporary files of Zarr.
_UNFINISHED = "*.partial"
# Arrays of a map are (h, ordinate, x); all others have fewer axes.
_IMAGE_AXES = 3
# Array of a map that is written last. A row block is finished if none of its elements has the fill value.
_LAST = "fate"


class SweepStore:
    """A Zarr group (format 3) with arrays (h, ordinate, x) and a flag for each finished energy.

    Parameters
    ----------
    path
        Folder of a store made by `create_store`.
    """

    def __init__(self, path: Path) -> None:
        require_package("zarr", "files")
        # Slow to import, and seldom used.
        import zarr

        self.path = path
        group = zarr.open_group(path, mode="r+", zarr_format=_FORMAT)
        self.attributes = dict(group.attrs)
        self._arrays = dict(group.arrays())
        images = (name for name, array in self._arrays.items() if array.ndim == _IMAGE_AXES)
        self._images = sorted(images, key=lambda name: name == _LAST)
        self._chunk_rows = self._arrays[_LAST].chunks[1]

    def check_request(self, attributes: dict[str, Any], coordinates: dict[str, np.ndarray]) -> None:
        """Raise a ValueError that names the difference if the store belongs to another request."""
        for name, wanted in _as_stored(attributes).items():
            if self.attributes.get(name) != wanted:
                found = self.attributes.get(name)
                raise ValueError(f"store={self.path}: holds another sweep, with {name}={found!r}; must have {name}={wanted!r}")
        for name, values in coordinates.items():
            if name not in self._arrays or not np.array_equal(self._arrays[name][...], values):
                raise ValueError(f"store={self.path}: holds another sweep, with other values of {name}; they must be equal")

    def prepare_writing(self) -> None:
        """Delete the temporary files of a killed run. Raises an OSError if no file can be created in the store."""
        with tempfile.TemporaryFile(dir=self.path):
            pass
        for unfinished in self.path.rglob(_UNFINISHED):
            unfinished.unlink()

    def pending(self) -> list[int]:
        """Return the indices of the unfinished energies, ascending."""
        indices: list[int] = np.flatnonzero(~np.asarray(self._arrays[DONE][...], bool)).tolist()
        return indices

    def unfinished_blocks(self, index: int, blocks: Sequence[np.ndarray]) -> list[int]:
        """Return the numbers of the row blocks of an energy that are not finished, ascending."""
        chunks = range(self._arrays[_LAST].cdata_shape[1])
        missing = np.concatenate([self._missing_rows(index, chunk) for chunk in chunks])
        return [number for number, rows in enumerate(blocks) if missing[rows].any()]

    def write(self, index: int, rows: np.ndarray, block: EscapeMap) -> None:
        """Write the given rows of one energy.

        Chunks are replaced atomically, and each array is on the disk before the next one is written: against power cuts, and to
        detect a full disk in time.
        """
        for name in self._images:
            self._arrays[name].oindex[index, rows] = getattr(block, name)
            for chunk in np.unique(rows // self._chunk_rows).tolist():
                _sync_to_disk(self._chunk_file(name, index, chunk))

    def mark_done(self, index: int) -> None:
        """Mark an energy as finished."""
        self._arrays[DONE][index] = True

    def open_dataset(self) -> xr.Dataset:
        """Open the arrays, without the flags; they are read from the disk on access."""
        # Slow to import, and seldom used.
        import xarray as xr

        dataset: xr.Dataset = xr.open_zarr(self.path, chunks=None, consolidated=False, zarr_format=_FORMAT)
        return dataset.drop_vars(DONE)

    def _missing_rows(self, index: int, chunk: int) -> np.ndarray:
        """Which rows of a chunk are not finished. If it cannot be read, as after a power cut, it is deleted."""
        rows = slice(chunk * self._chunk_rows, (chunk + 1) * self._chunk_rows)
        try:
            images = [self._arrays[name][index, rows] for name in self._images]
        except RuntimeError:
            for name in self._images:
                self._chunk_file(name, index, chunk).unlink(missing_ok=True)
            return self._missing_rows(index, chunk)
        missing: np.ndarray = np.any(images[-1] == self._arrays[_LAST].fill_value, axis=1)
        return missing

    def _chunk_file(self, name: str, index: int, chunk: int) -> Path:
        return self.path / name / "c" / str(index) / str(chunk) / "0"


def _sync_to_disk(path: Path) -> None:
    """Flush a chunk; chunks that hold only the fill value have no file."""
    if path.exists():
        with path.open("rb+") as file:
            os.fsync(file.fileno())


def create_store(
    path: Path,
    template: xr.Dataset,
    fill_values: dict[str, Any],
    coordinates: dict[str, np.ndarray],
    attributes: dict[str, Any],
    chunk_rows: int,
) -> None:
    """Create an empty store atomically: under a temporary name, which is then replaced.

    Parameters
    ----------
    path
        Folder of the store; must not exist, or be empty.
    template
        A map of any size with the names, types, dimensions and attributes of the arrays.
    fill_values
        The value of missing elements of each array.
    coordinates
        h, then the dimensions of a map in order.
    attributes
        Provenance of the sweep, as plain values.
    chunk_rows
        Rows per chunk.
    """
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        _create_group(unfinished, template, fill_values, coordinates, attributes, chunk_rows)
        os.replace(unfinished, path)
    except BaseException:
        shutil.rmtree(unfinished, ignore_errors=True)
        raise


def _create_group(
    path: Path,
    template: xr.Dataset,
    fill_values: dict[str, Any],
    coordinates: dict[str, np.ndarray],
    attributes: dict[str, Any],
    chunk_rows: int,
) -> None:
    require_package("zarr", "files")
    # Slow to import, and seldom used.
    import zarr

    group = zarr.create_group(path, zarr_format=_FORMAT, attributes=_as_stored(attributes))
    shape = tuple(values.size for values in coordinates.values())
    chunks = (1, chunk_rows, *shape[2:])
    for key, array in template.data_vars.items():
        name = str(key)
        group.create_array(
            name, shape=shape, chunks=chunks, dtype=array.dtype, fill_value=fill_values[name],
            dimension_names=list(coordinates), attributes=_as_stored(array.attrs),
        )  # fmt: skip
    for name, values in coordinates.items():
        group.create_array(name, data=values, dimension_names=[name], attributes={"units": "1"})
    # One chunk, and thus one file, per energy: a flag is written atomically.
    group.create_array(DONE, shape=shape[:1], chunks=(1,), dtype=bool, fill_value=False, dimension_names=["h"])
    with warnings.catch_warnings():
        # All metadata in one file are an extension of format 3, without which xarray warns and opens more slowly.
        warnings.filterwarnings("ignore", "Consolidated metadata", zarr.errors.ZarrUserWarning)
        zarr.consolidate_metadata(path, zarr_format=_FORMAT)


def _as_stored(attributes: dict[Any, Any]) -> dict[str, Any]:
    """The attributes as they are read back from JSON."""
    plain: dict[str, Any] = json.loads(json.dumps(attributes))
    return plain
