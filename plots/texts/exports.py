"""Write results as files: datasets as NetCDF, orbits and curves as CSV, and a Python script that reproduces a view."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from importlib.util import find_spec
from textwrap import indent
from typing import TYPE_CHECKING, Any

from engine import CASES, EscapeMap, MapSpec, Orbit, Potential, Result, Section, Slice, System, Window, judge_orbit
from engine import __all__ as public_names  # type: ignore[attr-defined]
from engine.jobs.job import Job
from engine.results import OrbitVerdict
from engine.systems.system import TYPED
from plots.layers.layer import NO_ANALYSES, Analyses
from plots.layers.table import LAYERS
from plots.pictures.provenance import program_version

if TYPE_CHECKING:
    import xarray as xr

MOST_ROWS = 100_000
"""Default limit of the number of rows in a table of orbits."""

_COLUMNS = ("t", "x", "y", "px", "py", "sali", "lyapunov_exponent", "r2")


def netcdf_bytes(frame: EscapeMap, analyses: Analyses = NO_ANALYSES) -> bytes:
    """Return the content of the NetCDF file of a map, with variables of the results of its layers, such as ``origin``."""
    names = ((layer, name) for layer in analyses for name in LAYERS[layer].variables)
    dataset = frame.to_xarray().assign({name: analyses[layer].to_xarray()[name].variable for layer, name in names})
    # Shuffling and compression reduce a map to a quarter of its size, and make writing faster.
    return dataset_bytes(dataset, {name: {"zlib": True, "complevel": 1, "shuffle": True} for name in dataset.data_vars})


def dataset_bytes(dataset: xr.Dataset, encoding: Mapping[Any, Any] | None = None) -> bytes:
    """Return the NetCDF-4 file of a dataset, with `encoding` as in xarray. Without the extra ``files``, it is a NetCDF 3 file."""
    if find_spec("h5netcdf") is None:
        return bytes(dataset.to_netcdf(engine="scipy"))
    return bytes(dataset.to_netcdf(engine="h5netcdf", encoding=encoding))


def orbits_csv(orbits: Sequence[Orbit], most_rows: int = MOST_ROWS, verdicts: Sequence[OrbitVerdict] = ()) -> str:
    """Return a CSV table of orbits, numbered from 1: orbit, t, x, y, px, py, sali, lyapunov_exponent and r2 at full precision.

    Comment lines (#) at the top contain start, energy and verdict of each orbit, and say which samples are listed.

    Parameters
    ----------
    orbits
        The orbits. An empty sequence gives an empty table.
    most_rows
        Largest number of rows, at least 1 per orbit. From longer orbits, every k-th sample is listed.
    verdicts
        A verdict for each orbit; by default, the verdict of `engine.judge_orbit` without Birkhoff digits.

    Raises
    ------
    ValueError
        If `most_rows` is less than the number of orbits.
    """
    if most_rows < max(1, len(orbits)):
        raise ValueError(f"most_rows={most_rows}: must be at least 1, and one for each of {len(orbits)} orbits")
    strides = [math.ceil(orbit.t.size / (most_rows // len(orbits))) for orbit in orbits]
    comments, rows = [program_version()], []
    for number, (orbit, stride, verdict) in enumerate(zip(orbits, strides, verdicts or map(judge_orbit, orbits), strict=True), 1):
        comments += _header(number, orbit, stride, verdict)
        columns = [getattr(orbit, name)[::stride].tolist() for name in _COLUMNS]
        rows += [(number, *row) for row in zip(*columns, strict=True)]
    return write_csv(("orbit", *_COLUMNS), rows, comments)


def section_csv(orbits: Sequence[Orbit]) -> str:
    """Return a CSV table of the crossings of the section by orbits: orbit and crossing, both from 1, t, x, y, px and py."""
    comments, rows = [program_version()], []
    for number, orbit in enumerate(orbits, 1):
        comments += [*_origin(number, orbit), f"orbit {number}: {orbit.section.crossings_name}"]
        states, times = orbit.find_section_states()
        columns = zip(times.tolist(), *states.T.tolist(), strict=True)
        rows += [(number, crossing, *row) for crossing, row in enumerate(columns, 1)]
    return write_csv(("orbit", "crossing", "t", "x", "y", "px", "py"), rows, comments)


def write_csv(names: Iterable[str], rows: Iterable[Sequence[object]], comments: Iterable[str] = ()) -> str:
    """Return a CSV table with names of columns and numbers at full precision, below comment lines (#)."""
    lines = [*(f"# {comment}" for comment in comments), ",".join(names), *(",".join(map(repr, row)) for row in rows)]
    return "\n".join(lines) + "\n"


def _header(number: int, orbit: Orbit, stride: int, verdict: OrbitVerdict) -> list[str]:
    samples = f"one in {stride} of {orbit.t.size} samples" if stride > 1 else f"all {orbit.t.size} samples"
    return [*_origin(number, orbit), f"orbit {number}: {verdict.describe()}", f"orbit {number}: {samples}"]


def _origin(number: int, orbit: Orbit) -> list[str]:
    start = ", ".join(f"{name} = {float(getattr(orbit, name)[0])!r}" for name in ("x", "y", "px", "py"))
    # The energy of a start differs from h by rounding.
    return [f"orbit {number}: start {start}", f"orbit {number}: energy {orbit.energy:.15g}"]


def python_lines(spec: MapSpec, system: System, starts: Sequence[Sequence[float]] = (), study: Job[Any] | None = None) -> str:
    """Return a Python script that reproduces a map, orbits and a study with the engine, bit for bit, and draws them.

    Parameters
    ----------
    spec
        The map.
    system
        System of the map's potential.
    starts
        (x, y, px, py) of each orbit, finite.
    study
        The call of a study of this system, see `Study.call`; None for no study.

    Raises
    ------
    ValueError
        If a start is not four finite numbers.
    """
    # Each orbit of a map along a parameter belongs to another potential.
    has_orbits = bool(starts) and spec.plane.parameter is None
    lines = [
        f"potential = {_potential_expression(system)}",
        f"spec = {_expression(replace(spec, window=spec.find_window()))}",
        "escape_map = compute_map(spec)",
        "escape_map.plot()",
        *(_orbit_lines(starts) if has_orbits else []),
        *([f"study = {_expression(study)}", "study.plot()"] if study is not None else []),
        "pyplot.show()",
    ]
    words = re.findall(r"\w+", "\n".join(lines))
    names = sorted({*words}.intersection(public_names))
    imports = ["from matplotlib import pyplot", "", f"from escape_explorer import {', '.join(names)}"]
    if study is not None and study.function.__name__ not in public_names:
        # The study of another package.
        imports.append(f"from {study.function.__module__} import {study.function.__name__}")
    return "\n".join([*imports, "", *lines]) + "\n"


def _orbit_lines(starts: Sequence[Sequence[float]]) -> list[str]:
    return [
        *("starts = [", *(f"    {_state(start)}," for start in starts), "]"),
        "orbits = [integrate_orbit(potential, start, spec.t_max, section=spec.section) for start in starts]",
        *("for orbit in orbits:", "    orbit.plot()"),
    ]


def _expression(value: Any) -> str:
    """Return the expression of a call or an argument in a script, in which `potential` is the only potential."""
    match value:
        case Job():
            options = (f"{name}={_expression(option)}" for name, option in value.options)
            return f"{value.function.__name__}({', '.join([*map(_expression, value.arguments), *options])})"
        case Potential():
            return "potential"
        case Section():
            return repr(value.text)
        case Window():
            return f"Window{_numbers(value.edges)}"
        case Enum():
            return f"{type(value).__name__}.{value.name}"
        case _ if is_dataclass(value) and not isinstance(value, Slice):
            given = ",\n".join(f"{each.name}={_expression(getattr(value, each.name))}" for each in fields(value))
            return f"{type(value).__name__}(\n{indent(given, '    ')},\n)"
    return repr(value)


def _potential_expression(system: System) -> str:
    """Return the expression of the potential of a system, which families and sweeps along a parameter need."""
    if system.case == TYPED:
        parameters = "".join(f", {name}={value!r}" for name, value in system.parameters.items())
        return f"System.from_formula({system.formula!r}{parameters}).potential"
    if system.parameters:
        return f"System({system.case!r}, parameters={dict(system.parameters)!r}).potential"
    return f"{'CASES' if system.case in CASES else 'POTENTIALS'}[{system.case!r}]"


def _state(start: Sequence[float]) -> str:
    if len(start) != 4 or not all(map(math.isfinite, start)):
        raise ValueError(f"start={tuple(start)!r}: must be four finite numbers x, y, px, py")
    return _numbers(start)


def _numbers(numbers: Sequence[float]) -> str:
    return f"({', '.join(repr(float(number)) for number in numbers)})"


def file_stem(spec: MapSpec, case: str) -> str:
    """Return a file name for a map, without an ending: letters, digits and ``_ . + -`` only.

    The name contains the case, any rotation, plane, energy, t_max, the window unless the map shows the whole plane, and any
    section other than y = 0, upward.
    """
    energy = repr(spec.energy).strip("()").replace(", ", "-")
    rotation = f"-rotation{spec.potential.rotation:g}" if spec.potential.rotation else ""
    stem = f"escapes-{case}{rotation}-{spec.plane.key}-h{energy}-t{spec.t_max:g}"
    window = spec.given_window
    if window is not None:
        x, ordinate = window.ranges
        stem += "".join(f"-{low!r}_{high!r}" for low, high in (x, ordinate))
    return stem_of(stem, spec.section)


def stem_of(stem: str, section: Section) -> str:
    """Return the file name of results with any section other than the default; letters, digits and ``_ . + -`` only."""
    return re.sub(r"[^A-Za-z0-9_.+-]", "_", stem if section == Section.Y_UP else f"{stem}-{section.text}")


def table_csv(found: Result) -> str:
    """Return a CSV table of the columns of a result, below the attributes of its dataset as comments."""
    columns = found.columns()
    comments = (program_version(), *(f"{name}: {value}" for name, value in found.to_xarray().attrs.items()))
    return write_csv(columns, zip(*(column.tolist() for column in columns.values()), strict=True), comments)
