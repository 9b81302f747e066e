"""The store of a sweep: one Zarr group on disk, filled energy by energy.

Row blocks of an unfinished energy are kept in separate files, because a chunk of an array cannot hold a block together with its
mirror image.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from engine.sweeps.checkpoint_blocks import CheckpointBlocks

if TYPE_CHECKING:
    import xarray as xr

DONE = "done"
"""Array (h,) of bool: the finished energies. An element is written after all other arrays of its energy."""

CHECKPOINTS = "under_way"
"""Group whose folder holds the checkpoints of unfinished energies; it is empty to Zarr."""

_FORMAT: Final = 3
# Name of the temporary files of Zarr.
_UNFINISHED = "*.partial"
# Arrays of a map are (h, ordinate, x); all others have fewer axes.
_IMAGE_AXES = 3


class SweepStore:
    """A Zarr group (format 3) with arrays (h, ordinate, x) and a flag for each finished energy.

    Parameters
    ----------
    path
        Folder of a store made by `create_store`.
    """

    def __init__(self, path: Path) -> None:
        # Slow to import, and seldom used.
        import zarr

        self.path = path
        group = zarr.open_group(path, mode="r+", zarr_format=_FORMAT)
        self.attributes = dict(group.attrs)
        self._arrays = dict(group.arrays())
        self.image_names = [name for name, array in self._arrays.items() if array.ndim == _IMAGE_AXES]

    def check_request(self, attributes: dict[str, Any], coordinates: dict[str, np.ndarray]) -> None:
        """Raise a ValueError that names the difference if the store belongs to another request."""
        for name, wanted in _as_stored(attributes).items():
            if self.attributes.get(name) != wanted:
                found = self.attributes.get(name)
                raise ValueError(f"store={self.path}: holds another sweep, with {name}={found!r}; must have {name}={wanted!r}")
        for name, values in coordinates.items():
            if name not in self._arrays or not np.array_equal(self._arrays[name][...], values):
                raise ValueError(f"store={self.path}: holds another sweep, with other values of {name}; they must be equal")

    def check_writable(self) -> None:
        """Raise an OSError if no file can be created in the store."""
        with tempfile.TemporaryFile(dir=self.path):
            pass

    def pending(self) -> list[int]:
        """Return the indices of the unfinished energies, ascending."""
        indices: list[int] = np.flatnonzero(~self._done()).tolist()
        return indices

    def write(self, index: int, images: xr.Dataset) -> None:
        """Write all arrays of one energy, and mark it as finished once they are on the disk."""
        self._clear(index)
        for name in images.data_vars:
            self._arrays[str(name)][index] = images[name].to_numpy()
            self._sync_to_disk(str(name), index)
        self._arrays[DONE][index] = True

    def checkpoint(self, index: int) -> CheckpointBlocks:
        """Return the finished row blocks of an unfinished energy."""
        return CheckpointBlocks(self.path / CHECKPOINTS / str(index))

    def write_blocks(self, index: int, blocks: Sequence[np.ndarray]) -> None:
        """Write one energy as `write` does, from its checkpoint, and delete the checkpoint.

        At most one chunk of an array and one array of a block are in memory at a time.

        Parameters
        ----------
        index
            Index of the energy.
        blocks
            Row indices of each block.
        """
        self._clear(index)
        checkpoint = self.checkpoint(index)
        for name in self.image_names:
            for low in range(0, self._arrays[name].shape[1], self._arrays[name].chunks[1]):
                self._write_chunk(name, index, low, blocks, checkpoint)
            self._sync_to_disk(name, index)
        self._arrays[DONE][index] = True
        checkpoint.delete()

    def delete_obsolete_checkpoints(self) -> None:
        """Delete the checkpoints of finished energies, which a run leaves if it is killed before it deletes them."""
        for index in np.flatnonzero(self._done()).tolist():
            self.checkpoint(index).delete()

    def open_dataset(self) -> xr.Dataset:
        """Open the arrays, without the flags; they are read from the disk on access."""
        # Slow to import, and seldom used.
        import xarray as xr

        dataset: xr.Dataset = xr.open_zarr(self.path, chunks=None, consolidated=False, zarr_format=_FORMAT)
        return dataset.drop_vars(DONE)

    def _done(self) -> np.ndarray:
        return np.asarray(self._arrays[DONE][...], bool)

    def _write_chunk(self, name: str, index: int, low: int, blocks: Sequence[np.ndarray], checkpoint: CheckpointBlocks) -> None:
        array = self._arrays[name]
        high = min(low + array.chunks[1], array.shape[1])
        chunk = np.empty((high - low, array.shape[2]), array.dtype)
        for number, rows in enumerate(blocks):
            inside = (rows >= low) & (rows < high)
            if inside.any():
                chunk[rows[inside] - low] = checkpoint.read(number, name)[inside]
        array[index, low:high] = chunk

    def _clear(self, index: int) -> None:
        """Delete the arrays of an energy that a killed run left, including temporary files of Zarr."""
        for name in self.image_names:
            shutil.rmtree(self.path / name / "c" / str(index), ignore_errors=True)
        for unfinished in (self.path / DONE / "c").glob(_UNFINISHED):
            unfinished.unlink()

    def _sync_to_disk(self, name: str, index: int) -> None:
        """Flush the chunks of an energy before it is marked: against power cuts, and to detect a full disk in time."""
        for chunk in (self.path / name / "c" / str(index)).rglob("*"):
            if chunk.is_file():
                with chunk.open("rb+") as file:
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
    path.parent.mkdir(parents=True, exist_ok=True)
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
    group.create_group(CHECKPOINTS)
    # One chunk, and thus one file, per energy: a flag is written atomically.
    group.create_array(DONE, shape=shape[:1], chunks=(1,), dtype=bool, fill_value=False, dimension_names=["h"])


def _as_stored(attributes: dict[Any, Any]) -> dict[str, Any]:
    """The attributes as they are read back from JSON."""
    plain: dict[str, Any] = json.loads(json.dumps(attributes))
    return plain
