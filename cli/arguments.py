"""Read values such as the system, the slice, the energy and the start from the words of a command.

`READERS` lists functions that make a value from several options. A command with a parameter of the type of the value has these
options.
"""

from __future__ import annotations

import re
import reprlib
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Annotated, Any

import numpy as np
import typer

from cli.layer_options import LayerOptions, read_layers, read_study_settings
from cli.option_marks import DocumentedBy
from engine import (
    MEASURES,
    POTENTIALS,
    EnergyAxis,
    ParameterAxis,
    Plane,
    Potential,
    Section,
    Slice,
    SweepSpec,
    System,
    read_section,
    review_potential,
)
from engine.foundations.validation import checked_count, checked_number
from engine.slices.axes import Energy
from engine.slices.slice_text import AXIS_NAMES, read_slice
from engine.slices.window import GivenWindow
from engine.sweeps.axes import SweepAxis
from engine.sweeps.spec import MOST_VALUES
from engine.systems.parameters import WELL_PARAMETERS
from engine.systems.system import TYPED
from plots.pictures.palette import DEFAULT_PALETTE, PALETTES, Palette, find_palette
from plots.pictures.setting import Settings
from plots.texts.accepted_potentials import page_refusal

PLANE_HELP = (
    f"Slice of starts: {', '.join(plane.key for plane in Plane)}, or two axes such as x,theta: {', '.join(AXIS_NAMES)}, or a "
    "parameter with its range, x,epsilon=0.5:2; theta is the angle of the velocity, and beta its angle from the radius."
)
AGAINST_HELP = (
    f"{', '.join(axis.key for axis in EnergyAxis)}, or a parameter: {', '.join(WELL_PARAMETERS)} or a letter of the formula."
)
PALETTE_HELP = f"Colours: {', '.join(f'{key} ({palette.name})' for key, palette in PALETTES.items())}."


def find_system(case: Case) -> System:
    """Return the system of a case, without a review; ValueError for a case that is neither a name nor a formula.

    Parameters
    ----------
    case
        Potential: I, II or III as in Zotos (2014), a name listed by `potential`, or a formula in x and y, with clauses such as
        "; masses (8, 8)"; parameters follow @, as in III@omega_1=1.1,epsilon=0.5, or rotation=1 for the rate of the frame;
        letters of a formula are also parameters: 0.5(x^2+y^2)-a x y^2@a=1.5.
    """
    name, _, parameters = case.partition("@")
    unchanged = System(name) if name in POTENTIALS else System(TYPED, name)
    system = replace(unchanged, parameters=_read_parameters(case, unchanged, parameters) if parameters else {})
    if name in POTENTIALS:
        return system
    try:
        # The first access parses the formula.
        _ = system.potential
    except ValueError as error:
        raise ValueError(
            f"case={reprlib.repr(case)}: must be one of {', '.join(POTENTIALS)}, or a formula in x and y ({error})"
        ) from None
    return system


_SLOW = ", ".join(name for name, measure in MEASURES.items() if measure.slow)
Slow = Annotated[bool, typer.Option(help=f"Whether to compute the measures that take longest: {_SLOW}.")]
"""Type of the option that includes slow measures."""


def check_measures(chosen: Collection[str] | None, known: Collection[str]) -> list[str]:
    """Return the chosen names of measures in the order of `known`; ValueError for a name that is not known."""
    if unknown := [name for name in chosen or () if name not in known]:
        raise ValueError(f"measure={unknown[0]}: must be one of {', '.join(known)}")
    return [name for name in known if name in (chosen or ())]


Case = Annotated[str, typer.Argument(metavar="CASE"), DocumentedBy(find_system)]
"""Type of the argument CASE of commands."""


def find_potential(case: Case) -> Potential:
    """Return the potential of a name or of a formula in x and y, with optional parameters ``@omega_1=1.2,a=0.8``.

    Parameters
    ----------
    case
        Name or formula, as in `find_system`.

    Raises
    ------
    ValueError
        If the case is neither a name nor a formula, a parameter is invalid, or the potential is not supported.
    """
    potential = find_system(case).potential
    problem = page_refusal(review_potential(potential))
    if problem is not None:
        raise ValueError(f"case={reprlib.repr(case)}: {problem}")
    return potential


def file_name_part(case: str) -> str:
    """Return the part of file names that identifies a potential."""
    name, _, parameters = case.partition("@")
    return re.sub(r"[^A-Za-z0-9_.+-]", "_", "-".join([name if name in POTENTIALS else TYPED, *filter(None, [parameters])]))


def find_plane(
    system: System,
    plane: Annotated[str | None, typer.Option("--plane", "--axes", metavar="AXES", help=PLANE_HELP)] = Plane.X_PX.key,
    fix: Annotated[list[str] | None, typer.Option(metavar="NAME=VALUE")] = None,
) -> Slice | None:
    """Return the slice with some axes, which may be parameters of the system; None without axes.

    Parameters
    ----------
    system
        The system.
    plane
        Key of a plane, or two axes.
    fix
        Value of another coordinate, 0 by default; py=- sets the momentum that the energy determines, and its sign; can be
        repeated.
    """
    return None if plane is None else read_slice(plane, ",".join(fix or ()), system)


def find_section(section: Annotated[str, typer.Option(metavar="SECTION")] = Section.Y_UP.text) -> Section:
    """Return the surface of section.

    Parameters
    ----------
    section
        Where crossings are counted, such as "x = 0, px > 0", "y = 0.1 both", "angle = 30" or "apsis".
    """
    return read_section(section)


type GivenEnergy = float | None
"""Type of an optional energy, given as h or by the Jacobi constant."""

type OneEnergy = float
"""Type of a required energy, given as h or by the Jacobi constant."""


def find_energy(system: System, energy: float | None = None, jacobi: float | None = None) -> GivenEnergy:
    """Return the energy, given directly or by the Jacobi constant; ValueError if both are given.

    Parameters
    ----------
    system
        The system.
    energy
        h, dimensionless.
    jacobi
        Jacobi constant C instead of h in a rotating frame: C = −2h about the rotation axis (the barycentre), without μ(1 − μ).
    """
    if jacobi is None:
        return None if energy is None else checked_number("energy", energy)
    if energy is not None:
        raise ValueError(f"jacobi={jacobi}: give either --energy H or --jacobi C")
    return system.potential.jacobi_energy(checked_number("jacobi", jacobi))


def require_energy(energy: GivenEnergy) -> OneEnergy:
    """Return the energy; ValueError if none is given."""
    if energy is None:
        raise ValueError("energy: give --energy H, or --jacobi C in a rotating frame")
    return energy


def choose_energy(
    plane: Slice,
    energy: GivenEnergy = None,
    energies: Annotated[tuple[float, float] | None, typer.Option(metavar="LOW HIGH")] = None,
) -> Energy:
    """Return the energy of a map, or the range of an axis h; ValueError unless exactly the option for the slice is given.

    Parameters
    ----------
    plane
        The slice.
    energy
        The result of `find_energy`.
    energies
        Range of h, for slices with an axis h.
    """
    if plane.energy_axis is not None:
        if energies is None or energy is not None:
            raise ValueError(f"energies: the plane {plane.key} needs --energies LOW HIGH{_describe_excess('--energy', energy)}")
        return energies
    if energy is None or energies is not None:
        raise ValueError(f"energy: the plane {plane.key} needs --energy H{_describe_excess('--energies', energies)}")
    return energy


def _describe_excess(option: str, value: object) -> str:
    """Return the end of a message about an option that must be left out; empty if it is left out."""
    return "" if value is None else f", not {option}"


def read_palette(palette: Annotated[str, typer.Option(help=PALETTE_HELP)] = DEFAULT_PALETTE) -> Palette:
    """Return the palette with a name; ValueError for an unknown name."""
    return find_palette(palette)


def read_resolution(text: str) -> tuple[int, int]:
    """Return (columns, rows) from ``N`` or ``NxM``."""
    match = re.fullmatch(r"(\d{1,9})(?:[x×](\d{1,9}))?", text)
    if match is None:
        raise typer.BadParameter(f"{text!r} must be N or NxM, whole numbers of columns and rows")
    columns, rows = match.groups()
    return int(columns), int(rows or columns)


def space_values(
    low: float | None, high: float | None, count: int | None, listed: Sequence[float] | None = None
) -> tuple[float, ...]:
    """Return the values of a sweep: evenly spaced with both ends, or as listed; ValueError for any other combination of options.

    Parameters
    ----------
    low
        Lowest h, or value of the parameter.
    high
        Highest h, or value of the parameter.
    count
        Number of evenly spaced values.
    listed
        One energy, instead of --low, --high and --count; can be repeated.
    """
    has_span = any(value is not None for value in (low, high, count))
    if listed and not has_span:
        return tuple(listed)
    if listed or low is None or high is None or count is None:
        raise ValueError("energies: give --low, --high and --count, or repeat --energy")
    low, high = checked_number("low", low), checked_number("high", high)
    if not (low < high or (low == high and count == 1)):
        raise ValueError(f"low={low}, high={high}: low must be below high")
    return tuple(np.linspace(low, high, checked_count("count", count, 1, MOST_VALUES)).tolist())


def swept_axis(name: str, low: float, high: float, system: System) -> SweepAxis:
    """Return the axis of a sweep with a name: h, jacobi, or a parameter of the system, with its range."""
    energies = {axis.key: axis for axis in EnergyAxis}
    return energies[name] if name in energies else ParameterAxis(name, low, high, system)


def read_sweep(
    *,
    system: System,
    potential: Potential,
    low: Annotated[float, DocumentedBy(space_values)],
    high: Annotated[float, DocumentedBy(space_values)],
    count: Annotated[int, DocumentedBy(space_values)],
    against: Annotated[str, typer.Option(help=AGAINST_HELP)] = "h",
    energy: Annotated[float | None, typer.Option(help="h of all maps along a parameter.")] = None,
    plane: Slice,
    resolution: Annotated[tuple[int, int], DocumentedBy(SweepSpec)] = (112, 112),
    t_max: Annotated[float, DocumentedBy(SweepSpec)],
    section: Section,
) -> SweepSpec:
    """Return the request of a sweep along one axis, with the shares as its only measure."""
    values, along = space_values(low, high, count), swept_axis(against, low, high, system)
    return SweepSpec(
        potential, plane, values, resolution, t_max=t_max, measures=("shares",), along=along, energy=energy, section=section
    )


READERS: Mapping[Any, Callable[..., Any]] = {
    System: find_system,
    Potential: find_potential,
    Slice: find_plane,
    Slice | None: find_plane,
    Section: find_section,
    Energy: choose_energy,
    GivenEnergy: find_energy,
    OneEnergy: require_energy,
    Palette: read_palette,
    LayerOptions: read_layers,
    Settings: read_study_settings,
    SweepSpec: read_sweep,
}
"""Functions that make values from options, by type of the value. A parameter of a function may also have a type listed here."""

OPTION_TYPES: Mapping[Any, Any] = {
    GivenWindow | None: Annotated[tuple[float, float, float, float] | None, typer.Option(metavar="X0 X1 Y0 Y1")],
    tuple[int, int]: Annotated[str, typer.Option(metavar="N or NxM", parser=read_resolution)],
}
"""The types that Typer reads, by type of the parameter. Typer reads other types as they are."""


def _read_parameters(case: str, system: System, text: str) -> dict[str, float]:
    legal = system.parameter_names
    values: dict[str, float] = {}
    for part in text.split(","):
        name, _, value = part.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = None
        if name.strip() not in legal or number is None:
            raise ValueError(f"case={reprlib.repr(case)}: parameters are {', '.join(legal)}, as in III@omega_1=1.1,epsilon=0.5")
        values[name.strip()] = number
    return values
