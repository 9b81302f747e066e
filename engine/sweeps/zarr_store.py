"""The store of a sweep: one labelled Zarr group on disk, filled energy by energy, each marked as done when it is all there.

Bands of an energy under way wait beside its arrays, as chunks of an array cannot follow a band and its mirror image.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
import xarray as xr
import zarr

from engine.sweeps.checkpoint_blocks import KeptBands

DONE = "done"
"""The array (h,) that says which energies are finished; the only one that is written after all others."""

UNDER_WAY = "under_way"
"""The group, empty for whoever reads Zarr, in whose folder the bands of an energy under way are kept."""

_FORMAT: Final = 3
# What Zarr calls a file that it has not finished.
_UNFINISHED = "*.partial"
# h, ordinate, x: coordinates and marks have fewer.
_IMAGE_AXES = 3


class SweepStore:
    """A Zarr group (format 3) with arrays (h, ordinate, x) and the marks of the energies that are done.

    Parameters
    ----------
    path
        A store that `create_store` made.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        group = zarr.open_group(path, mode="r+", zarr_format=_FORMAT)
        self.attributes = dict(group.attrs)
        self._arrays = dict(group.arrays())
        self.image_names = [name for name, array in self._arrays.items() if array.ndim == _IMAGE_AXES]

    def check_request(self, attributes: dict[str, Any], coordinates: dict[str, np.ndarray]) -> None:
        """ValueError, naming what differs, unless the store was made for this request."""
        for name, wanted in _as_stored(attributes).items():
            if self.attributes.get(name) != wanted:
                found = self.attributes.get(name)
                raise ValueError(f"store={self.path}: holds another sweep, with {name}={found!r}; must have {name}={wanted!r}")
        for name, values in coordinates.items():
            if name not in self._arrays or not np.array_equal(self._arrays[name][...], values):
                raise ValueError(f"store={self.path}: holds another sweep, with other values of {name}; they must be the same")

    def check_writable(self) -> None:
        """OSError unless files can be made in the store."""
        with tempfile.TemporaryFile(dir=self.path):
            pass

    def pending(self) -> list[int]:
        """Places along h that are not done, rising."""
        places: list[int] = np.flatnonzero(~np.asarray(self._arrays[DONE][...], bool)).tolist()
        return places

    def write(self, place: int, images: xr.Dataset) -> None:
        """Keep all arrays of one energy, and mark it as done once they are on the disk."""
        self._clear(place)
        for name in images.data_vars:
            self._arrays[str(name)][place] = images[name].to_numpy()
            self._bring_to_disk(str(name), place)
        self._arrays[DONE][place] = True

    def kept_bands(self, place: int) -> KeptBands:
        """The bands of an energy that has not been written yet."""
        return KeptBands(self.path / UNDER_WAY / str(place))

    def write_bands(self, place: int, bands: Sequence[np.ndarray]) -> None:
        """As `write`, from the kept bands, which are deleted then; `bands` are the numbers of their rows.

        One chunk of one array is in memory at a time, and one of a band.
        """
        self._clear(place)
        kept = self.kept_bands(place)
        for name in self.image_names:
            for low in range(0, self._arrays[name].shape[1], self._arrays[name].chunks[1]):
                self._write_chunk(name, place, low, bands, kept)
            self._bring_to_disk(name, place)
        self._arrays[DONE][place] = True
        kept.discard()

    def discard_leftovers(self) -> None:
        """Delete bands of energies that are done: a run was killed before it did."""
        for place in np.flatnonzero(np.asarray(self._arrays[DONE][...], bool)).tolist():
            self.kept_bands(place).discard()

    def _write_chunk(self, name: str, place: int, low: int, bands: Sequence[np.ndarray], kept: KeptBands) -> None:
        array = self._arrays[name]
        high = min(low + array.chunks[1], array.shape[1])
        chunk = np.empty((high - low, array.shape[2]), array.dtype)
        for number, rows in enumerate(bands):
            wanted = (rows >= low) & (rows < high)
            if wanted.any():
                chunk[rows[wanted] - low] = kept.read(number, name)[wanted]
        array[place, low:high] = chunk

    def _clear(self, place: int) -> None:
        """Delete what a killed run left of the arrays of an energy, Zarr's unfinished files included."""
        for name in self.image_names:
            shutil.rmtree(self.path / name / "c" / str(place), ignore_errors=True)
        for unfinished in (self.path / DONE / "c").glob(_UNFINISHED):
            unfinished.unlink()

    def open_dataset(self) -> xr.Dataset:
        """The arrays, read from the disk when they are looked at; without the marks."""
        whole: xr.Dataset = xr.open_zarr(self.path, chunks=None, consolidated=False, zarr_format=_FORMAT)
        return whole.drop_vars(DONE)

    def _bring_to_disk(self, name: str, place: int) -> None:
        """Else a mark could survive a power cut that its arrays do not, and a full disk be noticed too late."""
        for chunk in (self.path / name / "c" / str(place)).rglob("*"):
            if chunk.is_file():
                with chunk.open("rb+") as file:
                    os.fsync(file.fileno())


def create_store(
    path: Path,
    labels: xr.Dataset,
    fills: dict[str, Any],
    coordinates: dict[str, np.ndarray],
    attributes: dict[str, Any],
    band: int,
) -> None:
    """Make an empty store, which appears under its name only when it is whole.

    Parameters
    ----------
    path
        Where; nothing may be there but an empty folder.
    labels
        A map of any size, for the names, types, dimensions and attributes of the arrays.
    fills
        For each array the number where nothing is known.
    coordinates
        h first, then the dimensions of a map in order.
    attributes
        What made the sweep, in plain values.
    band
        Rows of a chunk.
    """
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.partial")
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        _fill_group(unfinished, labels, fills, coordinates, attributes, band)
        os.replace(unfinished, path)
    except BaseException:
        shutil.rmtree(unfinished, ignore_errors=True)
        raise


def _fill_group(
    path: Path,
    labels: xr.Dataset,
    fills: dict[str, Any],
    coordinates: dict[str, np.ndarray],
    attributes: dict[str, Any],
    band: int,
) -> None:
    group = zarr.create_group(path, zarr_format=_FORMAT, attributes=_as_stored(attributes))
    shape = tuple(values.size for values in coordinates.values())
    chunks = (1, band, *shape[2:])
    for key, array in labels.data_vars.items():
        name = str(key)
        group.create_array(
            name, shape=shape, chunks=chunks, dtype=array.dtype, fill_value=fills[name],
            dimension_names=list(coordinates), attributes=_as_stored(array.attrs),
        )  # fmt: skip
    for name, values in coordinates.items():
        group.create_array(name, data=values, dimension_names=[name], attributes={"units": "1"})
    group.create_group(UNDER_WAY)
    # A mark is a file of its own: there or not.
    group.create_array(DONE, shape=shape[:1], chunks=(1,), dtype=bool, fill_value=False, dimension_names=["h"])


def _as_stored(attributes: dict[Any, Any]) -> dict[str, Any]:
    """The attributes as they come back from JSON."""
    plain: dict[str, Any] = json.loads(json.dumps(attributes))
    return plain
