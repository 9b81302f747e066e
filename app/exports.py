"""What can be taken along: pictures, a map's numbers, orbits, and the lines that make them again."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from importlib import metadata
from io import BytesIO

from PIL import Image
from PIL.PngImagePlugin import PngInfo

from app.rendering.map_analyses import NO_ANALYSES, MapAnalyses
from app.rendering.map_figure import draw_picture
from app.rendering.map_images import TITLES
from app.rendering.palette import Palette
from app.state.system import TYPED, System
from engine import CASES, EscapeMap, MapSpec, Orbit

MOST_ROWS = 100_000
"""As many rows of numbers a table of orbits has, unless somebody asks for more."""

_COLUMNS = ("t", "x", "y", "px", "py", "sali", "lyapunov_exponent", "r2")


def png_bytes(
    frame: EscapeMap,
    pictures: Sequence[str],
    palette: Palette,
    side: int,
    *,
    findings: MapAnalyses = NO_ANALYSES,
    starts: Sequence[tuple[float, float]] = (),
) -> bytes:
    """A PNG file of some pictures side by side, with the map's provenance in its text fields.

    Parameters are those of `draw_picture`.

    Raises
    ------
    ValueError
        When no picture is chosen, or as in `draw_picture`.
    """
    if not pictures:
        raise ValueError(f"pictures={pictures!r}: must be at least one of {', '.join(TITLES)}")
    drawn = [draw_picture(frame, name, palette, side, findings=findings, starts=starts) for name in pictures]
    page = Image.new("RGB", (sum(image.width for image in drawn), max(image.height for image in drawn)), "white")
    for k, image in enumerate(drawn):
        page.paste(image, (sum(before.width for before in drawn[:k]), 0))
    notes = PngInfo()
    notes.add_text("Software", f"escape-explorer {metadata.version('escape-explorer')}")
    for name, value in frame.provenance().items():
        notes.add_text(name, str(value))
    file = BytesIO()
    page.save(file, "PNG", pnginfo=notes)
    return file.getvalue()


def netcdf_bytes(frame: EscapeMap, findings: MapAnalyses = NO_ANALYSES) -> bytes:
    """A NetCDF-4 file of `EscapeMap.to_xarray`, for `xarray.open_dataset` and any reader of HDF5.

    What second looks have found goes with it: ``character``, ``trust`` and ``origin``.
    """
    dataset = findings.add_to(frame.to_xarray())
    # Shuffled and squeezed, a map takes a quarter of the room, in less time than it takes to write it plain.
    squeezed = {name: {"zlib": True, "complevel": 1, "shuffle": True} for name in dataset.data_vars}
    return bytes(dataset.to_netcdf(engine="h5netcdf", encoding=squeezed))


def orbits_csv(orbits: Sequence[Orbit], most_rows: int = MOST_ROWS) -> str:
    """A table of orbits, numbered from 1: orbit, t, x, y, px, py, sali, lyapunov_exponent, r2, at full precision.

    Lines before it that begin with # hold each orbit's start, energy and verdict, and which of its samples follow.

    Parameters
    ----------
    most_rows
        As many rows of numbers at most, at least one an orbit; a long orbit is thinned to every k-th sample.

    Raises
    ------
    ValueError
        When `most_rows` is less than the number of orbits.
    """
    if most_rows < max(1, len(orbits)):
        raise ValueError(f"most_rows={most_rows}: must be at least 1, and one for each of {len(orbits)} orbits")
    strides = [math.ceil(orbit.t.size / (most_rows // len(orbits))) for orbit in orbits]
    lines = [f"# escape-explorer {metadata.version('escape-explorer')}"]
    for number, (orbit, stride) in enumerate(zip(orbits, strides, strict=True), 1):
        lines += _header(number, orbit, stride)
    lines.append(",".join(("orbit", *_COLUMNS)))
    for number, (orbit, stride) in enumerate(zip(orbits, strides, strict=True), 1):
        lines += _rows(number, orbit, stride)
    return "\n".join(lines) + "\n"


def _header(number: int, orbit: Orbit, stride: int) -> list[str]:
    start = ", ".join(f"{name} = {float(getattr(orbit, name)[0])!r}" for name in ("x", "y", "px", "py"))
    kept = f"one in {stride} of {orbit.t.size} samples" if stride > 1 else f"all {orbit.t.size} samples"
    return [
        f"# orbit {number}: start {start}",
        f"# orbit {number}: energy {orbit.energy!r}",
        f"# orbit {number}: {orbit.describe()}",
        f"# orbit {number}: {kept}",
    ]


def _rows(number: int, orbit: Orbit, stride: int) -> Iterator[str]:
    columns = [getattr(orbit, name)[::stride].tolist() for name in _COLUMNS]
    return (f"{number}," + ",".join(map(repr, row)) for row in zip(*columns, strict=True))


def python_lines(spec: MapSpec, system: System, starts: Sequence[Sequence[float]] = ()) -> str:
    """A script that makes the same map, and the same orbits, with the engine alone, to the bit.

    Parameters
    ----------
    spec
        The map.
    system
        Where its potential is from.
    starts
        (x, y, px, py) of each orbit, finite.

    Raises
    ------
    ValueError
        When a start is not four finite numbers.
    """
    source, made = _potential_line(system)
    names = [source, "MapSpec", "Plane", "Window", "compute_map", *(["integrate_orbit"] if starts else [])]
    window = spec.window
    edges = (window.x_low, window.x_high, window.ordinate_low, window.ordinate_high)
    energy = _numbers(spec.energy) if isinstance(spec.energy, tuple) else repr(float(spec.energy))
    lines = [
        f"from engine import {', '.join(names)}",
        "",
        f"potential = {made}",
        "spec = MapSpec(",
        "    potential,",
        f"    Plane.{spec.plane.name},",
        f"    energy={energy},",
        f"    resolution={spec.resolution!r},",
        f"    window=Window{_numbers(edges)},",
        f"    t_max={spec.t_max!r},",
        f"    certify={spec.certify!r},",
        ")",
        "escape_map = compute_map(spec)",
    ]
    if starts:
        lines += ["starts = [", *(f"    {_state(start)}," for start in starts), "]"]
        lines += ["orbits = [integrate_orbit(potential, start, spec.t_max) for start in starts]"]
    return "\n".join(lines) + "\n"


def _potential_line(system: System) -> tuple[str, str]:
    """The name that makes the potential, and the expression."""
    parameters = ", ".join(f"{name}={value!r}" for name, value in system.changed.items())
    changed = f".with_parameters({parameters})" if parameters else ""
    if system.case == TYPED:
        return "parse_formula", f"parse_formula({system.formula!r}){changed}"
    if system.case in CASES:
        return "CASES", f"CASES[{system.case!r}]{changed}"
    return "POTENTIALS", f"POTENTIALS[{system.case!r}].potential{changed}"


def _state(start: Sequence[float]) -> str:
    if len(start) != 4 or not all(map(math.isfinite, start)):
        raise ValueError(f"start={tuple(start)!r}: must be four finite numbers x, y, px, py")
    return _numbers(start)


def _numbers(numbers: Sequence[float]) -> str:
    return f"({', '.join(repr(float(number)) for number in numbers)})"


def file_stem(spec: MapSpec, case: str) -> str:
    """A name for files about a map, without an ending: letters, digits and ``_ . + -`` only."""
    energies = spec.energy if isinstance(spec.energy, tuple) else (spec.energy,)
    stem = f"escapes-{case}-{spec.plane.name.lower()}-h{'-'.join(repr(float(energy)) for energy in energies)}"
    return re.sub(r"[^A-Za-z0-9_.+-]", "_", stem)
