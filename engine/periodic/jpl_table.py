"""Tables of periodic orbits with the columns of the catalogue of NASA's Jet Propulsion Laboratory.

The catalogue, https://ssd.jpl.nasa.gov/tools/periodic_orbits.html, has orbits of the restricted three-body problem: states from
the barycentre of the two bodies in the rotating frame, in units of their distance and of 1/Ω, with the larger body at negative x.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from engine.exits.closed_orbit import ClosedOrbit
from engine.foundations.arrays import read_only
from engine.foundations.output_lock import output_named_in_errors
from engine.foundations.validation import checked_items, checked_path, checks_types
from engine.systems.potential import Potential

_STATE_COLUMNS = ("x", "y", "z", "vx", "vy", "vz")
_READ_COLUMNS = (*_STATE_COLUMNS, "jacobi")
_COLUMNS = (*_READ_COLUMNS, "period", "stability")

# Largest |z| and |vz| of an orbit in the plane, and largest difference of a Jacobi constant from that of its state. Published
# mass ratios of the same bodies differ by less.
_PLANE, _SAME_SYSTEM = 1e-9, 1e-4


def write_jpl_table(orbits: ClosedOrbit | Iterable[ClosedOrbit], path: str | os.PathLike[str]) -> None:
    """Write periodic orbits of a rotating system as a CSV table with the columns of the catalogue of JPL.

    The columns are x, y, z, vx, vy, vz, from the axis of the frame, jacobi, C as in `Potential.jacobi_constant`, period, and
    stability, ½(abs(λ) + 1/abs(λ)) with the larger multiplier λ of motion in the plane: 1 for a stable orbit. The catalogue takes
    the largest of all multipliers, also of motion out of the plane. Numbers are dimensionless, with all their digits.

    Parameters
    ----------
    orbits
        A `PeriodicOrbit` or `LyapunovOrbit`, or several, as an `OrbitFamily` or the result of `find_periodic_orbits` or
        `find_lyapunov_orbits`. Each has a row, with its start.
    path
        The file; an existing file is replaced.

    Raises
    ------
    ValueError
        If an orbit has another type, or its frame does not rotate.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from escape_explorer import POTENTIALS, find_periodic_orbit, write_jpl_table
    >>> orbit = find_periodic_orbit(POTENTIALS["Earth-Moon"], [-0.18, 0.0, 0.0, 0.52], returns=1)
    >>> with TemporaryDirectory() as folder:
    ...     write_jpl_table(orbit, f"{folder}/table.csv")
    ...     Path(f"{folder}/table.csv").read_text().splitlines()[0]
    'x,y,z,vx,vy,vz,jacobi,period,stability'
    """
    import pandas as pd

    members = checked_items("orbits", [orbits] if isinstance(orbits, ClosedOrbit) else orbits, ClosedOrbit)
    table = pd.DataFrame([_row(orbit) for orbit in members], columns=_COLUMNS)
    file = checked_path("path", path)
    with output_named_in_errors(file):
        table.to_csv(file, index=False)


def _row(orbit: ClosedOrbit) -> Sequence[float]:
    potential = orbit.potential
    constant = potential.jacobi_constant(orbit.energy)
    x, y = orbit.start[:2] - potential.rotation_axis
    vx, vy = orbit.start[2:] / potential.mass
    return x, y, 0.0, vx, vy, 0.0, constant, orbit.period, max(abs(orbit.stability_index), 1.0)


@checks_types(potential=Potential)
def read_jpl_table(potential: Potential, path: str | os.PathLike[str]) -> np.ndarray:
    """Read the starts of periodic orbits from a CSV table of the catalogue of JPL, or one that `write_jpl_table` wrote.

    `find_periodic_orbit` closes the orbit of each start at the energy ``potential.energy(start)``.

    Parameters
    ----------
    potential
        The system of the table, such as ``POTENTIALS["Earth-Moon"]``, in any coordinates whose axis x has both bodies. Its unit
        of length is the distance of the bodies, its unit of time 1/Ω.
    path
        The table, with names of columns in its first line: x, y, z, vx, vy, vz and jacobi as in files of the service, or x0 (LU),
        … and Jacobi constant as in files of the web page. Other columns are not read.

    Returns
    -------
    (n, 4) x, y, px, py in the coordinates of the potential, a row for each row of the table; read-only.

    Raises
    ------
    ValueError
        If a column is missing, a number is not finite, an orbit leaves the plane, or a Jacobi constant is not that of its state
        in this system, to 1e-4; if the frame of the potential does not rotate.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from escape_explorer import POTENTIALS, find_periodic_orbit, read_jpl_table
    >>> moon = POTENTIALS["Earth-Moon"]
    >>> text = "x,y,z,vx,vy,vz,jacobi,period,stability\\n0.805910793,0,0,0,0.51916996,0,2.92862125,3.20145435,1"
    >>> with TemporaryDirectory() as folder:
    ...     _ = Path(f"{folder}/table.csv").write_text(text)
    ...     (start,) = read_jpl_table(moon, f"{folder}/table.csv")
    >>> find_periodic_orbit(moon, start, returns=1).describe()
    'Periodic orbit, stable, T = 3.20145, a = −0.718214, 1 return to y = 0.'
    """
    file = checked_path("path", path)
    numbers = _read_numbers(file)
    z, vz, constants = numbers[:, 2], numbers[:, 5], numbers[:, 6]
    _check_rows(file, np.maximum(np.abs(z), np.abs(vz)) <= _PLANE, "z and vz must be 0, because the motion is in the plane")
    states = np.column_stack([numbers[:, :2] + potential.rotation_axis, numbers[:, 3:5] * potential.mass])
    differences = np.abs(potential.jacobi_constant(potential.energy(states)) - constants)
    is_same = differences <= _SAME_SYSTEM
    _check_rows(file, is_same, f"jacobi must be the constant of its state in {potential.name}; is it a table of another system?")
    return read_only(states)


def _read_numbers(path: Path) -> np.ndarray:
    """Return the columns `_READ_COLUMNS` of a table, (n, 7)."""
    import pandas as pd

    try:
        table = pd.read_csv(path, skipinitialspace=True)
    except ValueError as error:
        # The errors of pandas for the content of a file are ValueErrors.
        raise ValueError(f"path={path}: cannot be read as a table ({error}); must be a file of comma-separated values") from None
    # "x0 (LU)" is x, and "Jacobi constant (LU2/TU2)" jacobi.
    names = [re.sub(r"[^a-z].*", "", str(name).strip().lower()) for name in table.columns]
    missing = [name for name in _READ_COLUMNS if name not in names]
    if missing:
        raise ValueError(f"path={path}: has no columns {', '.join(missing)}; must have {', '.join(_READ_COLUMNS)}")
    columns = table.iloc[:, [names.index(name) for name in _READ_COLUMNS]]
    numbers = columns.apply(pd.to_numeric, errors="coerce").to_numpy(dtype=float)
    _check_rows(path, np.isfinite(numbers).all(axis=1), "must have finite numbers")
    return numbers


def _check_rows(path: Path, is_legal: np.ndarray, rule: str) -> None:
    """Raise a ValueError that names the first row that is not legal, counted from 1."""
    if not is_legal.all():
        raise ValueError(f"path={path}: row {int(np.argmin(is_legal)) + 1}: {rule}")
