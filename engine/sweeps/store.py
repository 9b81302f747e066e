"""The store of a sweep: a Zarr group on disk to which values are appended one by one."""

from __future__ import annotations

import logging
import shutil
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.foundations.extras import require_package
from engine.foundations.output_lock import hold_lock, output_named_in_errors, sync_to_disk
from engine.slices.sections.section_text import FORMER_ATTRIBUTES
from engine.sweeps.axes import axis_names
from engine.sweeps.stored_metadata import (
    ARRAYS_ATTRIBUTE,
    CHECKSUM_ATTRIBUTE,
    COUNT_ATTRIBUTE,
    METADATA_FILE,
    OPTIONS,
    check_metadata,
    metadata_checksum,
    read_stored,
    without_values,
)
from engine.sweeps.stored_values import count_complete, encodings, has_axis

if TYPE_CHECKING:
    import xarray as xr
    import zarr

# Pattern of the names of the temporary files of Zarr.
_PARTIAL_FILES = "*.partial"
# Names of attributes that follow from the potential, but whose wording may differ between versions.
_WORDED_ATTRIBUTES = ("outcomes", "exit_names")
# A chunk that equals the value of missing data is written as well, so that its file is known to be missing.
_WRITING_OPTIONS: Mapping[str, Any] = {**OPTIONS, "write_empty_chunks": True}

log = logging.getLogger(__name__)


@contextmanager
def open_store(path: Path, attributes: Mapping[str, Any]) -> Iterator[SweepStore]:
    """Open the store of a request, new or with some of its values, locked for this process.

    Raises
    ------
    ValueError
        If the folder contains another request or other files, or its parent folder does not exist.
    OSError
        If the store cannot be written to.
    BlockingIOError
        If another process has locked the store.
    """
    require_package("zarr", "files")
    if not path.absolute().parent.exists():
        raise ValueError(f"store={path}: the folder {path.parent} does not exist; make it first")
    with hold_lock(path):
        yield SweepStore(path, attributes)


class SweepStore:
    """The measures of a sweep at its values on disk, in the order in which they were appended.

    Arrays have one chunk, and thus one file, for each value. The number of finished values is written last. A killed process
    therefore loses only the current value.
    """

    def __init__(self, path: Path, attributes: Mapping[str, Any]) -> None:
        self._path, self._attributes = path, dict(attributes)
        # Name of the dimension along which values are appended.
        self._axis = axis_names(attributes)[0]
        # Number of values on the disk.
        self._finished = 0
        # A run that was killed at its start leaves incomplete files only.
        if path.exists() and not all(file.match(_PARTIAL_FILES) for file in path.iterdir()):
            self._resume()

    def read(self) -> xr.Dataset:
        """Return all values in ascending order; arrays are read from the disk on access."""
        return read_stored(self._path) if self._finished else without_values(self._attributes)

    def append(self, point: xr.Dataset) -> None:
        """Add a value. It counts only after its arrays are on the disk, in case of a power failure or a full disk."""
        first: dict[str, Any] = {"mode": "w", "encoding": encodings(point)}
        mode = {"append_dim": self._axis} if self._finished else first
        state = {COUNT_ATTRIBUTE: self._finished, ARRAYS_ATTRIBUTE: sorted(map(str, point.variables))}
        with output_named_in_errors(self._path):
            if not self._finished:
                self._remove_arrays()
            point.assign_attrs(self._attributes | state).to_zarr(self._path, **mode, **_WRITING_OPTIONS)
            for pattern in ("*/zarr.json", f"*/c/{self._finished}", f"*/c/{self._finished}/**/*", "**/"):
                for written in self._path.glob(pattern):
                    sync_to_disk(written)
            self._set_finished(self._finished + 1)

    def _remove_arrays(self) -> None:
        """Remove arrays without complete values, while the file is still there by which the next run knows the store."""
        for folder in self._path.glob("*/"):
            shutil.rmtree(folder)

    def _set_finished(self, count: int) -> None:
        """Write the number of finished values, in one file with the metadata of all arrays, to the disk."""
        group = _consolidate(self._path)
        group.attrs.update({COUNT_ATTRIBUTE: count, CHECKSUM_ATTRIBUTE: metadata_checksum(self._path)})
        for written in (self._path / METADATA_FILE, self._path, self._path.parent):
            sync_to_disk(written)
        self._finished = count

    def _resume(self) -> None:
        """Continue after the values of an earlier run, and remove the incomplete data of a killed run."""
        attributes, arrays = self._open_attributes(), self._open_arrays()
        if not (attributes or arrays):
            # A run was killed before it wrote its request.
            return
        finished = attributes.get(COUNT_ATTRIBUTE, 0)
        check_same_sweep(f"store={self._path}", attributes, self._attributes)
        if arrays.keys() >= set(attributes.get(ARRAYS_ATTRIBUTE, ())):
            check_metadata(f"store={self._path}", self._path)
            self._finished = count_complete(self._path, arrays, self._axis, finished)
        # Arrays may contain values that do not count.
        too_long = [array for array in arrays.values() if has_axis(array, self._axis) and array.shape[0] > self._finished]
        if self._finished == self._attributes["count"] and not too_long:
            return
        # If the store is not writable, this fails before anything is computed.
        with tempfile.TemporaryFile(dir=self._path):
            pass
        for file in self._path.rglob(_PARTIAL_FILES):
            file.unlink()
        for array in too_long:
            array.resize((self._finished, *array.shape[1:]))
        if self._finished < finished:
            log.warning("store=%s: the data of value %d are damaged; computing from there", self._path, self._finished + 1)
            self._set_finished(self._finished)

    def _open_attributes(self) -> dict[str, Any]:
        """Return the attributes of the group."""
        import zarr

        if not (self._path / METADATA_FILE).exists():
            raise ValueError(
                f"store={self._path}: holds other files but no {METADATA_FILE}; must be new, empty, or the store of this request"
            )
        with self._damage_named(METADATA_FILE):
            return dict(zarr.open_group(self._path, mode="r+", use_consolidated=False).attrs)

    def _open_arrays(self) -> dict[str, zarr.Array[Any]]:
        """Return the arrays of the group that have metadata, by name."""
        import zarr

        arrays = {}
        for file in self._path.glob(f"*/{METADATA_FILE}"):
            name = file.parent.name
            with self._damage_named(f"{name}/{METADATA_FILE}"):
                arrays[name] = zarr.open_array(file.parent, mode="r+")
        return arrays

    @contextmanager
    def _damage_named(self, file: str) -> Iterator[None]:
        """Name a file of the store in errors of its metadata."""
        try:
            yield
        except (ValueError, KeyError, TypeError) as error:
            problem = f"store={self._path}: its file {file} cannot be read: {error}"
            raise ValueError(f"{problem}; restore it, or delete the folder to compute everything again") from error


def check_same_sweep(label: str, found: Mapping[str, Any], wanted: Mapping[str, Any], *, ignored: Sequence[str] = ()) -> None:
    """Raise a ValueError that states the difference if the attributes `found` belong to another request.

    Attributes that are `ignored` are not compared.
    """
    found = {**FORMER_ATTRIBUTES, **found}
    # Other attributes follow from the axes, and a default window follows from others. Types differ in files.
    for name, value in sorted(wanted.items(), key=lambda item: (item[0] == "window") - (item[0] == "axis")):
        is_compared = name not in {*ignored, *_WORDED_ATTRIBUTES}
        if is_compared and (name not in found or np.ravel(found[name]).tolist() != np.ravel(value).tolist()):
            raise ValueError(f"{label}: holds another request, with {name}={found.get(name)!r}; must have {name}={value!r}")


def _consolidate(path: Path) -> zarr.Group:
    """Collect the metadata of all arrays in one file, an extension of format 3. Otherwise xarray warns and opens more slowly.

    Returns
    -------
    The group, which keeps the collected metadata when its attributes change.
    """
    import zarr

    with warnings.catch_warnings():
        # Of the extension, and of folders of arrays that have been lost.
        warnings.simplefilter("ignore", zarr.errors.ZarrUserWarning)
        return zarr.consolidate_metadata(path, zarr_format=3)
