"""Conversion of command-line arguments to engine requests."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from cli.options import Edges
from cli.potential_argument import find_potential, find_system
from engine import MapSpec, Slice
from engine.slices.slice_text import read_slice
from plots.pictures.palette import PALETTES, Palette


def find_palette(name: str) -> Palette:
    """Return the palette of this name; ValueError if there is none."""
    if name not in PALETTES:
        raise ValueError(f"palette={name!r}: must be one of {', '.join(PALETTES)}")
    return PALETTES[name]


def find_plane(axes: str, fix: Sequence[str] | None, case: str) -> Slice:
    """Return the slice of these axes, whose parameters are those of a case."""
    return read_slice(axes, ",".join(fix or ()), find_system(case))


def read_resolution(text: str) -> tuple[int, int]:
    """Return (columns, rows) from ``N`` or ``NxM``; ValueError for anything else."""
    match = re.fullmatch(r"(\d{1,9})(?:[x×](\d{1,9}))?", text)
    if match is None:
        raise ValueError(f"resolution={text!r}: must be N or NxM, whole numbers of columns and rows")
    columns, rows = match.groups()
    return int(columns), int(rows or columns)


def space_energies(
    low: float | None, high: float | None, count: int | None, listed: Sequence[float] | None = None
) -> tuple[float, ...]:
    """Return the energies of a sweep, either evenly spaced including both ends or as listed; ValueError otherwise."""
    span = (low, high, count)
    if listed and not any(one is not None for one in span):
        return tuple(listed)
    if listed or low is None or high is None or count is None:
        raise ValueError("energies: give --low, --high and --count, or repeat --energy")
    if not (low < high or (low == high and count == 1)):
        raise ValueError(f"low={low}, high={high}: the lower energy must be below the higher one")
    return tuple(np.linspace(low, high, count).tolist())


def build_map_spec(
    case: str,
    axes: str,
    fix: Sequence[str] | None,
    energy: float | None,
    energies: tuple[float, float] | None,
    window: Edges | None,
    resolution: str,
    t_max: float,
    use_evidence: bool,
    backward: bool = False,
) -> MapSpec:
    """Return the request for a map; ValueError names a missing, superfluous or invalid option."""
    potential, plane = find_potential(case), find_plane(axes, fix, case)
    return MapSpec(
        potential,
        plane,
        _choose_energy(plane, energy, energies),
        read_resolution(resolution),
        window,
        t_max,
        use_evidence,
        backward,
    )


def _choose_energy(plane: Slice, energy: float | None, energies: tuple[float, float] | None) -> float | tuple[float, float]:
    if plane.energy_axis is not None:
        if energies is None or energy is not None:
            raise ValueError(f"energies: the plane {plane.key} needs --energies LOW HIGH, not --energy")
        return energies
    if energy is None or energies is not None:
        raise ValueError(f"energy: the plane {plane.key} needs --energy H, not --energies")
    return energy


def find_start(
    case: str,
    axes: str,
    fix: Sequence[str] | None,
    energy: float | None,
    start: tuple[float, float] | None,
    state: tuple[float, float, float, float] | None,
) -> tuple[float, float, float, float]:
    """Return x, y, px, py of a start, given as a state or as a point of a plane; ValueError if it is forbidden."""
    if (start is None) == (state is None):
        raise ValueError("start: give either --start X ORDINATE on a plane, or --state X Y PX PY")
    if state is not None:
        if energy is not None:
            raise ValueError("energy: --state already determines it; leave --energy out")
        return state
    assert start is not None
    chosen = find_plane(axes, fix, case)
    chosen.check_one_potential("start")
    if chosen.energy_axis is not None and energy is not None:
        raise ValueError(f"energy: on the plane {chosen.key} it is a coordinate, so leave --energy out")
    if chosen.energy_axis is None and energy is None:
        raise ValueError(f"energy: a start on the plane {chosen.key} needs --energy H")
    x, ordinate = np.array(start)[:, None]
    found = chosen.states(find_potential(case), energy, x, ordinate)[0]
    if np.isnan(found).any():
        raise ValueError(f"start={start}: forbidden, an orbit there would have negative kinetic energy")
    first, second, third, fourth = found.tolist()
    return first, second, third, fourth
