"""The request of a sweep: maps at many values of the energy or of parameters, and the measures of each map."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.foundations.validation import (
    LARGEST_NUMBER,
    check_type,
    checked_between,
    checked_count,
    checked_number,
    short_repr,
)
from engine.maps.spec import DEFAULT_RESOLUTION, MapSpec
from engine.measures.measured_map import SweepPoint
from engine.measures.table import MEASURES
from engine.slices.axes import Coordinate, ParameterAxis
from engine.slices.default_window import map_window
from engine.slices.parameter_family import Member, ParameterFamily, parameter_family
from engine.slices.planes import checked_slice
from engine.slices.sections.section import Section
from engine.slices.slice import Slice
from engine.slices.window import GivenWindow
from engine.sweeps.axes import AXIS_SEPARATOR, EnergyAxis, SweepAxis, checked_axes, write_axes
from engine.sweeps.plate_family import PlateFamily, lines, plate_family
from engine.systems.outcomes import Outcome, write_outcomes
from engine.systems.potential import Potential

MOST_VALUES = 10_000
"""Largest number of values on an axis of a sweep."""

MOST_REFINED = 1000
"""Largest number of refining values of a sweep."""

VALUE_ATTRIBUTES = ("requested", "refine", "count")
"""Names of the attributes of a sweep that describe only its values and their number."""


@dataclass(frozen=True)
class SweepSpec:
    """A sweep of maps over the energy or a parameter of the system, or over a pair of these, on one plane.

    Parameters
    ----------
    potential
        The `Potential`; along parameters, the potential of their system.
    plane
        A slice of one energy and one potential, such as (x, y) or (x, px).
    values
        1 to 10 000 values on the axis, by default energies h; finite, dimensionless. They are sorted and made unique. Along a
        pair of axes, a pair of such sequences.
    resolution
        Columns and rows of the map at each value, each 1 to 4096.
    window
        The window of all maps, see `MapSpec`. None for the default window of each map, which contains the whole interior. With
        the measure "maps", whose arrays have common axes, None stands for the default window of the highest energy. In cases I to
        III the interior grows with h on (x, y) and (x, px), so this window contains the windows of all other energies.
    t_max
        Integration time, dimensionless, 0 < t_max ≤ 1e8; by default as in `MapSpec`.
    use_evidence
        Whether orbits may be called bounded before t_max on evidence, see `MapSpec`.
    measures
        Names of `MEASURES` to compute for each map; "maps" stores the arrays of the map itself.
    along
        The axis: a `ParameterAxis`, "h" or None for the energy, or "jacobi" for the Jacobi constant of a rotating frame. Or a
        pair of these, at most one of them an energy: then results have two dimensions, with a map for each pair of values.
        Outcomes have the numbers defined by `ParameterAxis`. Along two parameters they are followed along the second, and from
        there along the first, where exits that appear get the next numbers.
    energy
        h of all maps along parameters alone; None if the energy follows from an axis.
    refine
        Number of additional values on the first axis, 0 to 1000, chosen while the sweep runs. Each is the middle of the two
        neighbouring values between which the share of an exit, or of bounded starts, changes most. The measure "shares" is
        required.
    section
        The surface of section at which crossings are counted: a `Section` or text, see `read_section`.

    Raises
    ------
    ValueError
        When a parameter is invalid. The message names the parameter, its value and the legal values.
    """

    potential: Potential
    plane: Slice
    values: Sequence[Any] | np.ndarray
    resolution: tuple[int, int] = DEFAULT_RESOLUTION
    window: GivenWindow | None = None
    t_max: float = None  # type: ignore[assignment]
    use_evidence: bool = True
    measures: Sequence[str] = ("maps",)
    along: SweepAxis | tuple[SweepAxis, ...] | None = None
    energy: float | None = None
    refine: int = 0
    section: Section = Section.Y_UP

    # `__init__` accepts more types than the fields have, and converts them. This declaration is for type checkers.
    if TYPE_CHECKING:

        def __init__(
            self,
            potential: Potential,
            plane: Slice | str,
            values: Sequence[float] | Sequence[Sequence[float] | np.ndarray] | np.ndarray,
            resolution: Sequence[int] = DEFAULT_RESOLUTION,
            window: GivenWindow | None = None,
            t_max: float | None = None,
            use_evidence: bool = True,
            measures: Sequence[str] = ("maps",),
            along: SweepAxis | str | Sequence[SweepAxis | str] | None = None,
            energy: float | None = None,
            refine: int = 0,
            section: Section | str = Section.Y_UP,
        ) -> None: ...

    def __post_init__(self) -> None:
        check_type("potential", self.potential, Potential)
        axes = checked_axes(self.along)
        has_energy = any(isinstance(axis, EnergyAxis) for axis in axes)
        if has_energy != (self.energy is None):
            raise ValueError(f"energy={short_repr(self.energy)}: must be given along parameters alone, and None along the energy")
        plane, measures = _checked_plane(self.plane), _checked_measures(self.measures)
        values = _checked_pair(self.values) if len(axes) > 1 else _checked_values("values", self.values)
        object.__setattr__(self, "along", axes if len(axes) > 1 else axes[0])
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "measures", measures)
        _, highest_energy = self.energy_range
        for parameter, parameter_values in zip(axes, self.axis_values, strict=True):
            if isinstance(parameter, ParameterAxis):
                # This validates the parameter, which must belong to the system of the potential.
                MapSpec(self.potential, Slice(Coordinate.X, parameter), highest_energy)
                for value in (parameter_values[0], parameter_values[-1]):
                    checked_between(parameter.key, value, *parameter.system.range_of(parameter.key))
        refine = checked_count("refine", self.refine, 0, MOST_REFINED)
        if refine > 0 and "shares" not in measures:
            raise ValueError(f"refine={self.refine}: must be 0 without the measure 'shares', which decides where to refine")
        if "maps" in measures and self.parameters and self.window is None:
            raise ValueError("window=None: must be given for maps along a parameter, which have common axes")
        # The map at the highest energy checks the other fields and converts them.
        highest = MapSpec(
            self.potential, plane, highest_energy, self.resolution, self.window, self.t_max, self.use_evidence,
            section=self.section,
        )  # fmt: skip
        for name in ("plane", "resolution", "window", "t_max", "use_evidence", "section"):
            object.__setattr__(self, name, getattr(highest, name))

    @property
    def axes(self) -> tuple[SweepAxis, ...]:
        """The axes, one or two."""
        return checked_axes(self.along)

    @property
    def axis_values(self) -> tuple[tuple[float, ...], ...]:
        """The values on each axis, ascending, without those of `refine`."""
        return tuple(self.values) if len(self.axes) > 1 else (tuple(self.values),)

    @property
    def parameters(self) -> tuple[ParameterAxis, ...]:
        """The axes that are parameters."""
        return tuple(axis for axis in self.axes if isinstance(axis, ParameterAxis))

    @property
    def count(self) -> int:
        """Number of values on the first axis, including those of `refine`; a single value cannot be refined."""
        given = len(self.axis_values[0])
        return given + (self.refine if given > 1 else 0)

    @property
    def map_count(self) -> int:
        """Number of maps, including those of `refine`."""
        return self.count * math.prod(map(len, self.axis_values[1:]))

    @property
    def name(self) -> str:
        """The name of the first axis in datasets: "h", "jacobi", or the name of the parameter."""
        return self.axes[0].key

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes whose shares are measured, besides bounded orbits."""
        family = self._family
        return self.potential.outcomes_at(self.energy_range) if family is None else family.outcomes

    @property
    def searched_axes(self) -> tuple[ParameterAxis, ...]:
        """The parameters along which potentials are found: of two, the second, and the first at each value of the second."""
        if len(self.parameters) < 2:
            return self.parameters
        first, second = self.parameters
        return (second, *lines(first, second, self.axis_values[1]).values())

    def point(self, *place: float) -> SweepPoint:
        """Return the request for the measurement of one map, at a value on each axis.

        Raises ValueError if the system has no potential there.
        """
        by_axis = dict(zip(self.axes, place, strict=True))
        member = self._member(*(by_axis[axis] for axis in self.parameters))
        energy = self.energy
        for axis, value in by_axis.items():
            if isinstance(axis, EnergyAxis):
                energy = axis.energy(member.potential, value)
        assert energy is not None
        window = self._common_window()
        map_spec = MapSpec(
            member.potential, self.plane, energy, self.resolution, window, self.t_max, self.use_evidence, section=self.section
        )
        names = tuple((axis.key, value) for axis, value in by_axis.items())
        return SweepPoint(map_spec, names, tuple(self.measures), tuple(member.numbers_at(energy).tolist()), self.outcomes)

    @property
    def _family(self) -> ParameterFamily | PlateFamily | None:
        """The potentials along the parameters; None without parameters."""
        if len(self.parameters) < 2:
            return parameter_family(*self.parameters) if self.parameters else None
        first, second = self.parameters
        return plate_family(first, second, self.axis_values[1])

    def _member(self, *values: float) -> Member:
        """Return the potential at values of the parameters."""
        family = self._family
        if family is None:
            return Member(self.potential, np.arange(len(self.potential.outcomes) + 1))
        return family.member(*values)

    @property
    def energy_range(self) -> tuple[float, float]:
        """The lowest and the highest h of the maps in the potential of the request."""
        for axis, values in zip(self.axes, self.axis_values, strict=True):
            if isinstance(axis, EnergyAxis):
                low, high = sorted(axis.energy(self.potential, value) for value in (values[0], values[-1]))
                return low, high
        assert self.energy is not None
        return self.energy, self.energy

    def attributes(self) -> dict[str, Any]:
        """Return the request in plain values, with the integrator and the package version, as attributes of the dataset."""
        made_by = self.point(*(values[-1] for values in self.axis_values)).map_spec.provenance() | self.potential.provenance()
        # Names of attributes that differ from map to map.
        differing = {"jacobi_constant"}
        if self.parameters:
            differing.add("terms")
        if self.energy is None:
            differing.add("energy")
        if self._common_window() is None:
            differing |= {"window", "default_window"}
        system = asdict(self.parameters[0].system) if self.parameters else None
        further = zip(self.axes[1:], self.axis_values[1:], strict=True)
        return {
            "result": "Sweep",
            **{name: value for name, value in made_by.items() if name not in differing},
            "axis": AXIS_SEPARATOR.join(axis.key for axis in self.axes),
            "symbol": AXIS_SEPARATOR.join(axis.symbol for axis in self.axes),
            "along": write_axes(self.axes),
            "along_system": json.dumps(system),
            "measures": ", ".join(self.measures),
            "outcomes": write_outcomes(self.outcomes),
            "requested": list(self.axis_values[0]),
            **{f"{axis.key}_values": list(values) for axis, values in further},
            "refine": self.refine,
            "count": self.count,
        }

    def _common_window(self) -> GivenWindow | None:
        """Return the window of all maps; None if each map has its default window."""
        if self.window is None and "maps" in self.measures:
            return map_window(self.potential, self.plane, self.energy_range[1], self.resolution)
        return self.window


def _checked_plane(plane: Any) -> Slice:
    checked = checked_slice(plane)
    if checked.energy_axis is not None:
        raise ValueError(f"plane={checked.title}: must have no axis h, which already contains all energies")
    checked.check_one_potential("plane")
    return checked


def _checked_pair(values: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the values on two axes."""
    try:
        first, second = values
    except (TypeError, ValueError):
        raise ValueError(f"values={short_repr(values)}: must be a pair of sequences along a pair of axes") from None
    return _checked_values("values[0]", first), _checked_values("values[1]", second)


def _checked_values(name: str, values: Any) -> tuple[float, ...]:
    """Return the values, sorted and made unique."""
    try:
        checked = tuple(sorted({checked_number(name, value) for value in values}))
    except (TypeError, ValueError):
        legal = f"a sequence of finite numbers, at most {LARGEST_NUMBER:g} in magnitude"
        raise ValueError(f"{name}={short_repr(values)}: must be {legal}") from None
    if not 1 <= len(checked) <= MOST_VALUES:
        raise ValueError(f"{name}={short_repr(values)}: must be 1 to {MOST_VALUES} different numbers")
    return checked


def _checked_measures(measures: Any) -> tuple[str, ...]:
    """Return the names, in the order of `MEASURES`."""
    try:
        names = {measures} if isinstance(measures, str) else set(measures)
    except TypeError:
        # No sequence, or items without a hash.
        names = set()
    if not names or not names <= set(MEASURES):
        raise ValueError(f"measures={short_repr(measures)}: must be one or more of {', '.join(MEASURES)}")
    return tuple(name for name in MEASURES if name in names)
