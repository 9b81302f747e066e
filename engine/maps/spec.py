"""The request for an escape map. It is frozen, validated and hashable, so it also serves as a key of caches."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.foundations.extras import write_live_figure
from engine.foundations.validation import check_type, checked_count, checked_flag, replace_unchecked, short_repr
from engine.slices.axes import Energy, common_energy, scaled_energy
from engine.slices.default_window import map_window
from engine.slices.limiting_curves import trace_zero_velocity_curve
from engine.slices.parameter_family import parameter_family
from engine.slices.planes import checked_slice
from engine.slices.sections.section import Section
from engine.slices.sections.section_text import checked_section, section_of_file
from engine.slices.slice import Slice
from engine.slices.slice_text import read_slice, write_slice
from engine.slices.window import GivenWindow, Window, checked_window
from engine.systems.formulas.formula_parser import read_potential
from engine.systems.outcomes import Outcome
from engine.systems.potential import Potential
from engine.systems.system import System

if TYPE_CHECKING:
    import xarray as xr

LARGEST_SIDE = 4096
"""Largest number of columns or rows of a map."""

DEFAULT_RESOLUTION = (224, 224)
"""Default number of columns and rows of a map: even, so that no pixel lies on a line of symmetry."""

FINEST_PIXEL = 1e-15
"""Smallest distance of neighbouring pixels, as a share of the well's unit or, if larger, of the largest coordinate."""


@dataclass(frozen=True)
class MapSpec:
    """The request for an escape map: the orbits, the resolution and the integration time.

    Nothing is computed when a request is made. `find_window` computes the default window, which depends on the exits.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        The slice of starts: a `Plane` or another `Slice`. A plane can be given by name: "x_px", as on the command line, or
        "(x, px)".
    energy
        h, finite, dimensionless. On a slice with an axis h, a pair (low, high). At or below the escape energy, no orbit escapes.
    resolution
        Columns and rows, each 1 to 4096.
    window
        Part of the slice: a `Window`, or (x_low, x_high, ordinate_low, ordinate_high). None for the default window, which shows
        the whole interior, also after ``dataclasses.replace(spec, energy=…)``. With an odd number of columns or rows, a line of
        pixels could lie on a line of symmetry, on which orbits stay for ever. The default window is then shifted by half a pixel.
    t_max
        Integration time, 0 < t_max ≤ 1e8, dimensionless. The default is 1000/abs(Ω) in a rotating frame, otherwise 1000 with
        bodies or an escape radius, and otherwise 1e5. The first two are shorter because, without evidence of tori, each bounded
        orbit must be integrated to t_max. If the unit of time 1/ω of the well is above 1, the limit is 1e8 in this unit.
    use_evidence
        Whether an orbit may be called bounded before t_max, on evidence that it never escapes, see `Evidence`.
    backward
        Whether to follow orbits into the past. This equals following (x, y, −px, −py) into the future, with −Ω for Ω. Fates are
        then the outcomes backward in time, such as the channels through which orbits entered. Escape times count backward from
        the start. Crossings are those of the reversed orbit.
    section
        The surface of section at which crossings are counted: a `Section` or text, see `read_section`. The default is y = 0,
        upward, as in Zotos (2014).

    Raises
    ------
    ValueError
        If a parameter is invalid. The message names the parameter, its value and the legal values.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane
    >>> spec = MapSpec(CASES["III"], Plane.X_PX, 0.45)
    >>> spec.resolution, spec.t_max, round(spec.find_window().x_high, 4)
    ((224, 224), 100000.0, 1.0056)
    >>> MapSpec(CASES["III"], Plane.X_PX, 0.45, resolution=(0, 50))
    Traceback (most recent call last):
        ...
    ValueError: resolution=(0, 50): must be (columns, rows), each from 1 to 4096
    """

    potential: Potential
    plane: Slice
    energy: Energy
    resolution: tuple[int, int] = DEFAULT_RESOLUTION
    window: GivenWindow | None = None
    t_max: float = None  # type: ignore[assignment]
    use_evidence: bool = True
    backward: bool = False
    section: Section = Section.Y_UP

    # `__init__` accepts more types than the fields have, and converts them. This declaration is for type checkers.
    if TYPE_CHECKING:

        def __init__(
            self,
            potential: Potential,
            plane: Slice | str,
            energy: Energy | Sequence[float] | np.ndarray,
            resolution: Sequence[int] = DEFAULT_RESOLUTION,
            window: GivenWindow | None = None,
            t_max: float | None = None,
            use_evidence: bool = True,
            backward: bool = False,
            section: Section | str = Section.Y_UP,
        ) -> None: ...

    def __post_init__(self) -> None:
        check_type("potential", self.potential, Potential)
        plane = checked_slice(self.plane)
        checked = {
            "plane": plane,
            "energy": plane.checked_energy(self.energy),
            "resolution": _checked_resolution(self.resolution),
            "window": None if self.window is None else checked_window(self.window),
            "t_max": self.potential.checked_t_max(self.t_max),
            "use_evidence": checked_flag("use_evidence", self.use_evidence),
            "backward": checked_flag("backward", self.backward),
            "section": checked_section(self.section),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        if plane.parameter is not None and plane.parameter.system.potential != self.potential:
            raise ValueError(f"plane={plane.title}: its parameter belongs to another system; must be of {self.potential.name}")

    def different_fields(self, other: MapSpec) -> list[str]:
        """Return the names of the fields in which another request differs."""
        return [field.name for field in fields(self) if getattr(self, field.name) != getattr(other, field.name)]

    @property
    def common_energy(self) -> float | None:
        """h of all starts; None on a slice with an axis h."""
        return common_energy(self.energy)

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes with the fates 1, 2, …; along a parameter, those of all its potentials."""
        axis = self.plane.parameter
        return self.potential.outcomes_at(self.energy) if axis is None else parameter_family(axis).outcomes

    @property
    def given_window(self) -> Window | None:
        """The window as given; None for the default window."""
        return None if self.window is None else checked_window(self.window)

    def find_window(self) -> Window:
        """Return the window of the map: the given window, or the default window.

        Raises
        ------
        ValueError
            If no default window or no exit is defined at an energy, or the pixels are too close for double precision.
        """
        window = self.given_window or map_window(self.potential, self.plane, self.energy, self.resolution)
        _check_pixels(self, window)
        return window

    def trace_zero_velocity_curve(self) -> list[np.ndarray]:
        """Return the pieces (n, 2) of the boundary of the forbidden region, such as V(x, y) = h, in the window of the map.

        Examples
        --------
        >>> from escape_explorer import CASES, MapSpec, Plane
        >>> len(MapSpec(CASES["I"], Plane.X_PX, 0.19).trace_zero_velocity_curve())
        1
        """
        return trace_zero_velocity_curve(self.potential, self.plane, self.energy, self.find_window())

    def in_well_units(self) -> MapSpec:
        """Return the request in units of the well, with its window. The legal ranges of t_max and energy do not apply to it."""
        units, window = self.potential.units, self.find_window()
        potential = self.potential.reversed_in_time if self.backward else self.potential
        return replace_unchecked(
            self,
            potential=potential.in_well_units,
            plane=self.plane.in_well_units(units),
            # Units are powers of 2, so factors are exact.
            energy=scaled_energy(self.energy, 1.0 / units.energy),
            window=window.scaled(*(1.0 / unit for unit in self.plane.axis_units(units))),
            t_max=self.t_max / units.time,
            section=self.section.in_well_units(units),
        )

    def pixel_centres(self) -> tuple[np.ndarray, np.ndarray]:
        """Return x and ordinate of the pixel centres, (columns,) and (rows,)."""
        return self.find_window().pixel_centres(*self.resolution)

    def energies(self, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
        """Return h of n points of the slice, of shape (n,)."""
        return np.broadcast_to(self.plane.energies(self.common_energy, x, ordinate), np.shape(x))

    def start_states(self, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
        """Return the initial states x, y, px, py of n points of the slice, of shape (n, 4); NaN where forbidden."""
        states = self.plane.states(self.potential, self.common_energy, x, ordinate)
        if self.backward:
            states[:, 2:] *= -1.0
        return states

    def provenance(self) -> dict[str, Any]:
        """Return the request in plain values, with the integrator and the package version."""
        window = self.find_window()
        axes, fixed_values = write_slice(self.plane)
        parameter = self.plane.parameter
        return self.potential.describe_run(
            energy=self.energy,
            plane=self.plane.title,
            axes=axes,
            fix=fixed_values,
            system=json.dumps(None if parameter is None else asdict(parameter.system)),
            window=window.edges,
            default_window=int(self.window is None),
            resolution=self.resolution,
            t_max=self.t_max,
            use_evidence=int(self.use_evidence),
            backward=int(self.backward),
            section=self.section.text,
        )

    def to_html(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Compute the map and write it as a live figure, as `EscapeMap.to_html` does, with the same options and exceptions.

        Examples
        --------
        >>> from escape_explorer import CASES, MapSpec, Plane
        >>> MapSpec(CASES["III"], Plane.X_PX, 0.45, t_max=100.0).to_html("figure.html")  # doctest: +SKIP
        """
        write_live_figure(self, path, options)

    def pixel_at(self, x: float, ordinate: float) -> tuple[int, int] | None:
        """Return (row, column) of the pixel that contains a point of the slice; None outside the window."""
        window, (columns, rows) = self.find_window(), self.resolution
        column = np.floor((x - window.x_low) / window.width * columns)
        row = np.floor((ordinate - window.ordinate_low) / window.height * rows)
        return (int(row), int(column)) if 0 <= row < rows and 0 <= column < columns else None


def finest_pixel(spec: MapSpec, window: Window) -> tuple[float, float]:
    """Return the smallest distances of pixels, in x and in the ordinate, that double precision allows in a window."""
    x_unit, ordinate_unit = spec.plane.axis_units(spec.potential.units)
    largest_x = max(abs(window.x_low), abs(window.x_high))
    largest_ordinate = max(abs(window.ordinate_low), abs(window.ordinate_high))
    return FINEST_PIXEL * max(x_unit, largest_x), FINEST_PIXEL * max(ordinate_unit, largest_ordinate)


def _check_pixels(spec: MapSpec, window: Window) -> None:
    """Raise ValueError if neighbouring pixels are closer than `finest_pixel`."""
    for centres, finest in zip(window.pixel_centres(*spec.resolution), finest_pixel(spec, window), strict=True):
        if centres.size > 1 and np.min(np.diff(centres)) < finest:
            raise ValueError(f"window={window}: double precision ends here; pixels must be at least {finest:.2g} apart")


def _checked_resolution(resolution: Any) -> tuple[int, int]:
    try:
        columns, rows = (checked_count("resolution", side, 1, LARGEST_SIDE) for side in resolution)
    except (TypeError, ValueError):
        legal = f"(columns, rows), each from 1 to {LARGEST_SIDE}"
        raise ValueError(f"resolution={short_repr(resolution)}: must be {legal}") from None
    return columns, rows


def read_spec(dataset: xr.Dataset) -> MapSpec:
    """Return the request of a map from the attributes of its dataset. The energy of a map of a sweep is its coordinate h."""
    attributes = dataset.attrs
    if attributes.get("along"):
        raise ValueError(
            f"dataset: is a map of a sweep along {attributes['axis']}, whose energy, potential or fate numbers are those of the "
            "sweep; must be a map of compute_map, or of a sweep over h"
        )
    try:
        system_fields = json.loads(attributes["system"])
        # Without a parameter as axis, any system serves to read the slice.
        system = System(**system_fields) if system_fields else System("I")
        plane = read_slice(str(attributes["axes"]), str(attributes["fix"]), system)
        energy = attributes["energy"] if "energy" in attributes else float(dataset["h"].values)
        window = None if attributes["default_window"] else tuple(float(edge) for edge in attributes["window"])
        columns, rows = map(int, attributes["resolution"])
    except KeyError as error:
        raise ValueError(f"dataset: has no attribute {error}; must be the dataset of a map written by this version") from None
    return MapSpec(
        read_potential(attributes), plane, _plain_energy(energy), (columns, rows), window,  # type: ignore[arg-type]
        float(attributes["t_max"]), use_evidence=bool(attributes["use_evidence"]), backward=bool(attributes["backward"]),
        section=section_of_file(attributes),
    )  # fmt: skip


def _plain_energy(energy: Any) -> Any:
    """Return an energy as a float, or a pair of energies as a tuple of floats."""
    return tuple(map(float, energy)) if np.ndim(energy) else float(energy)
