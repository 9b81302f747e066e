"""Returns of more orbits than fit into memory, written row by row to a Zarr store."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_path, checks_types
from engine.maps.returns import Returns, check_request, compute_row
from engine.maps.spec import MapSpec
from engine.sweeps.store import open_store

if TYPE_CHECKING:
    import xarray as xr


@shows_progress("returns")
@checks_types(spec=MapSpec, store=(str, os.PathLike), execution=Execution)
def store_returns(
    spec: MapSpec, returns: int, store: str | os.PathLike[str], *, execution: Execution = DEFAULT_EXECUTION
) -> xr.Dataset:
    """Compute the returns of `compute_returns` row by row into a Zarr store, whose size is limited by the disk only.

    A row counts when it is on the disk. The same call continues an interrupted one, and recomputes damaged rows.

    Parameters
    ----------
    spec
        The starts, on a slice without a parameter as axis; `use_evidence` is not used.
    returns
        Largest number of returns of each orbit, 1 to 100 000; at most 5 million of all orbits of a row.
    store
        A folder: a new one, or the store of the same request.
    execution
        How the computation runs.

    Returns
    -------
    The dataset of the store, with the variables of `Returns.to_xarray`; arrays are read from the disk on access. Later
    `open_result` reads it as `Returns`, as far as it fits into memory.

    Raises
    ------
    BlockingIOError
        If another process is writing to the store.
    concurrent.futures.CancelledError
        If cancelled; completed rows are kept.
    OSError
        If the store cannot be written to.
    ValueError
        If `returns` is out of range, the slice has a parameter as axis, or the folder contains something else.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from escape_explorer import CASES, MapSpec, Plane, store_returns
    >>> with TemporaryDirectory() as folder:
    ...     found = store_returns(MapSpec(CASES["II"], Plane.X_PX, 0.15, (9, 7), t_max=100.0), 3, f"{folder}/returns.zarr")
    ...     dict(sorted(found.sizes.items())), int(found["return_time"].count())
    ({'px': 7, 'return': 3, 'x': 9}, 111)
    """
    columns, rows = spec.resolution
    check_request(spec, returns, columns)
    axis, _ = spec.plane.axis_names[::-1]
    attributes = {"result": Returns.__name__, **spec.provenance(), "returns": returns, "axis": axis, "count": rows}
    with open_store(checked_path("store", store), attributes) as storage:
        for row in range(storage.read().sizes[axis], rows):
            execution.report(lambda done=row: done / rows)  # type: ignore[misc]
            storage.append(compute_row(spec, returns, row, execution).transpose(axis, ...))
        execution.report(lambda: 1.0)
        return storage.read()
