"""NetCDF files with checksums, which are replaced as a whole, and whose damage is named."""

from __future__ import annotations

import os
from collections.abc import Hashable
from importlib.util import find_spec
from typing import TYPE_CHECKING

from engine.foundations.extras import require_package
from engine.foundations.output_lock import output_named_in_errors
from engine.foundations.validation import checked_path

if TYPE_CHECKING:
    import xarray as xr

# First bytes of HDF5 files, and thus of NetCDF 4 files.
_HDF5_SIGNATURE = b"\x89HDF"


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
    file = checked_path("path", path)
    if file.suffix != ".nc":
        raise ValueError(f"path={path}: must end in .nc")
    incomplete = file.with_name(f".{file.name}.{os.getpid()}.part")
    with output_named_in_errors(path):
        try:
            dataset.to_netcdf(incomplete, encoding=_checksums(dataset))
            incomplete.replace(file)
        finally:
            incomplete.unlink(missing_ok=True)


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
    problem = f"path={os.fspath(path)}: cannot be read as a NetCDF file"
    try:
        opened = xr.open_dataset(path)
    except OSError as error:
        raise OSError(f"{problem}: {error}") from error
    except ValueError:
        # No engine of xarray recognises the file.
        raise OSError(f"{problem}: its format is unknown") from None
    with opened as dataset:
        try:
            return dataset.load()
        except OSError as error:
            raise OSError(f"path={os.fspath(path)}: its data are damaged: {error}") from error
