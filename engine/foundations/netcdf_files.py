"""NetCDF files with checksums, which are replaced as a whole, and whose damage is named.

The checksum of the whole file stands after the NetCDF content. Other readers ignore it there, and programs that change the file
drop it. Checksums of arrays alone are not enough: when their index is damaged, HDF5 reads zeros, which look like bounded orbits.
"""

from __future__ import annotations

import hashlib
import io
import mmap
import os
from collections.abc import Hashable
from importlib.util import find_spec
from typing import TYPE_CHECKING, Literal

from engine.foundations.extras import require_package
from engine.foundations.output_lock import replaced_file
from engine.foundations.validation import checked_path

if TYPE_CHECKING:
    import xarray as xr

# First bytes of HDF5 files, and thus of NetCDF 4 files.
_HDF5_SIGNATURE = b"\x89HDF"
# Text before the checksum at the end of a file.
_MARK = b"\nsha256 "
# Length of the checksum with its mark.
_CHECKSUM_LENGTH = len(_MARK) + 2 * hashlib.sha256().digest_size


def write_netcdf(dataset: xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a dataset to a file. An existing file is replaced only by a complete file, even if the call is interrupted.

    Parameters
    ----------
    dataset
        The dataset. Its arrays of numbers get checksums where the format has them.
    path
        The file, whose name ends in ".nc".

    Raises
    ------
    ValueError
        If the name does not end in ".nc".
    OSError
        If the file cannot be written; the error names it.
    """
    target = checked_path("path", path)
    if target.suffix != ".nc":
        raise ValueError(f"path={path}: must end in .nc")
    # In memory, because HDF5 can end the process when a disk is full.
    engine: Literal["h5netcdf", "scipy"] = "scipy" if find_spec("h5netcdf") is None else "h5netcdf"
    buffer = io.BytesIO()
    dataset.to_netcdf(buffer, engine=engine, encoding=_checksums(dataset))
    content = buffer.getvalue()
    checksum = hashlib.sha256(content).hexdigest()
    with replaced_file(target) as incomplete, incomplete.open("xb") as file:
        file.write(content)
        file.write(_MARK + checksum.encode())


def _checksums(dataset: xr.Dataset) -> dict[Hashable, dict[str, bool]]:
    """Return the encoding with which arrays of numbers have checksums in a file, so that damaged data are not read.

    Without the extra ``files``, files are of NetCDF 3, which has no checksums.
    """
    if find_spec("h5netcdf") is None:
        return {}
    arrays = {name: variable for name, variable in dataset.variables.items() if variable.ndim and variable.size}
    return {name: {"fletcher32": True} for name, variable in arrays.items() if variable.dtype.kind in "biuf"}


def read_netcdf(path: str | os.PathLike[str]) -> xr.Dataset:
    """Return the dataset of a file, whose arrays are in memory.

    Raises
    ------
    OSError
        If the file cannot be read, is no NetCDF file, or is damaged; the error names it.
    """
    # The import is slow and seldom needed.
    import xarray as xr

    with open(path, "rb") as file:
        if file.read(len(_HDF5_SIGNATURE)) == _HDF5_SIGNATURE:
            require_package("h5netcdf", "files")
    problem, advice = f"path={os.fspath(path)}: cannot be read as a NetCDF file", "restore it, or delete it and compute it again"
    if not _is_unchanged(path):
        raise OSError(f"{problem}: is damaged; {advice}")
    try:
        with xr.open_dataset(path) as dataset:
            return dataset.load()
    except (OSError, RuntimeError, KeyError, AttributeError, UnicodeError) as error:
        # These are the errors of HDF5, and of the packages that read it, for damaged files.
        raise OSError(f"{problem}: {error}; {advice}") from error
    except ValueError:
        # No engine of xarray recognises the file.
        raise OSError(f"{problem}: its format is unknown") from None


def _is_unchanged(path: str | os.PathLike[str]) -> bool:
    """Return whether a file has the checksum at its end, or none, as files of other programs and earlier versions."""
    with open(path, "rb") as file:
        if os.fstat(file.fileno()).st_size <= _CHECKSUM_LENGTH:
            return True
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content, memoryview(content) as view:
            found = bytes(view[-_CHECKSUM_LENGTH:])
            with view[:-_CHECKSUM_LENGTH] as checked:
                checksum = hashlib.sha256(checked).hexdigest()
    return not found.startswith(_MARK) or found == _MARK + checksum.encode()
