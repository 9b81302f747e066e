"""From what was typed to what the engine is asked for."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from app.rendering.palette import PALETTES, Palette
from cli.options import Edges, PlaneName
from cli.potentials import find_potential
from engine import MapSpec, Plane, start_states


def find_palette(name: str) -> Palette:
    """The colours of a name; ValueError unless there are some."""
    if name not in PALETTES:
        raise ValueError(f"palette={name!r}: must be one of {', '.join(PALETTES)}")
    return PALETTES[name]


def find_plane(name: PlaneName) -> Plane:
    """The plane of a name."""
    return Plane[name.name]


def read_resolution(text: str) -> tuple[int, int]:
    """(columns, rows) from ``N`` or ``NxM``; ValueError when it is neither."""
    match = re.fullmatch(r"(\d{1,9})(?:[x×](\d{1,9}))?", text)
    if match is None:
        raise ValueError(f"resolution={text!r}: must be N or NxM, whole numbers of columns and rows")
    columns, rows = match.groups()
    return int(columns), int(rows or columns)


def space_energies(
    low: float | None, high: float | None, count: int | None, listed: Sequence[float] | None = None
) -> tuple[float, ...]:
    """The energies of a sweep, evenly spaced with both ends or as listed; ValueError unless it is one of the two, and whole."""
    span = (low, high, count)
    if listed and not any(one is not None for one in span):
        return tuple(listed)
    if listed or low is None or high is None or count is None:
        raise ValueError("energies: give --low, --high and --count, or --energy once for each")
    if not (low < high or (low == high and count == 1)):
        raise ValueError(f"low={low}, high={high}: the lower energy must be below the higher one")
    return tuple(np.linspace(low, high, count).tolist())


def build_map_spec(
    case: str,
    plane: PlaneName,
    energy: float | None,
    energies: tuple[float, float] | None,
    window: Edges | None,
    resolution: str,
    t_max: float,
    certify: bool,
    backward: bool = False,
) -> MapSpec:
    """The request for a map; ValueError, naming the option, where one is missing, too many or out of its range."""
    return MapSpec(
        find_potential(case),
        find_plane(plane),
        _choose_energy(plane, energy, energies),
        read_resolution(resolution),
        window,  # type: ignore[arg-type]  # MapSpec takes four edges, or None for the whole interior
        t_max,
        certify,
        backward,
    )


def _choose_energy(plane: PlaneName, energy: float | None, energies: tuple[float, float] | None) -> float | tuple[float, float]:
    if plane is PlaneName.X_H:
        if energies is None or energy is not None:
            raise ValueError("energies: the plane x_h takes a range, --energies LOW HIGH, and no --energy")
        return energies
    if energy is None or energies is not None:
        raise ValueError(f"energy: the plane {plane} takes one, --energy H, and no --energies")
    return energy


def find_start(
    case: str,
    plane: PlaneName,
    energy: float | None,
    start: tuple[float, float] | None,
    state: tuple[float, float, float, float] | None,
) -> tuple[float, float, float, float]:
    """x, y, px, py of one orbit, given as they are or as a point of a plane; ValueError when no orbit starts there."""
    if (start is None) == (state is None):
        raise ValueError("start: give either --start X ORDINATE on a plane, or --state X Y PX PY")
    if state is not None:
        if energy is not None:
            raise ValueError("energy: a whole state, --state, has its energy already")
        return state
    assert start is not None
    if plane is PlaneName.X_H and energy is not None:
        raise ValueError("energy: on the plane x_h the ordinate is the energy, so leave --energy out")
    if plane is not PlaneName.X_H and energy is None:
        raise ValueError(f"energy: a start on the plane {plane} needs --energy H")
    x, ordinate = np.array(start)[:, None]
    found = start_states(find_potential(case), find_plane(plane), 0.0 if energy is None else energy, x, ordinate)[0]
    if np.isnan(found[3]):
        raise ValueError(f"start={start}: forbidden, an orbit there would have negative kinetic energy")
    first, second, third, fourth = found.tolist()
    return first, second, third, fourth
