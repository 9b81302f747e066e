"""The request of a sweep: maps at many energies, or at many values of a parameter, and the measures of each map."""

from __future__ import annotations

import json
import numbers
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.foundations.validation import LARGEST_NUMBER, check_type, checked_count, short_repr
from engine.maps.spec import DEFAULT_RESOLUTION, MapSpec
from engine.measures.measured_map import SweepPoint
from engine.measures.table import MEASURES
from engine.slices.axes import Coordinate, ParameterAxis
from engine.slices.default_window import map_window
from engine.slices.parameter_family import parameter_family
from engine.slices.planes import checked_slice
from engine.slices.sections.section import Section
from engine.slices.slice import Slice
from engine.slices.slice_text import write_slice
from engine.slices.window import GivenWindow
from engine.systems.outcomes import Outcome, write_outcomes
from engine.systems.potential import Potential

MOST_VALUES = 10_000
"""Largest number of energies, or of values of a parameter, of one sweep."""

MOST_REFINED = 1000
"""Largest number of refining values of a sweep."""

VALUE_ATTRIBUTES = ("requested", "refine", "count")
"""Names of the attributes of a sweep that describe only its values and their number."""


@dataclass(frozen=True)
class SweepSpec:
    """A sweep of maps over energies, over a parameter of the system, or over both, on one plane.

    Parameters
    ----------
    potential
        The `Potential`; along a parameter, the potential of the parameter's system.
    plane
        A slice of one energy and one potential, such as (x, y) or (x, px).
    values
        1 to 10 000 energies h, or values of the parameter; finite, dimensionless. They are sorted and made unique.
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
        The parameter; None for a sweep over energies. Outcomes have the numbers defined by `ParameterAxis`.
    energy
        h of all maps along a parameter, or several energies: the second axis of the results, with a map at each energy for each
        value of the parameter; None for a sweep over energies.
    refine
        Number of additional values, 0 to 1000, chosen while the sweep runs. Each is the middle of the two neighbouring values
        between which the share of an exit, or of bounded starts, changes most. The measure "shares" is required.
    section
        The surface of section at which crossings are counted: a `Section` or text, see `read_section`.

    Raises
    ------
    ValueError
        When a parameter is invalid. The message names the parameter, its value and the legal values.
    """

    potential: Potential
    plane: Slice
    values: Sequence[float] | np.ndarray
    resolution: tuple[int, int] = DEFAULT_RESOLUTION
    window: GivenWindow | None = None
    t_max: float = None  # type: ignore[assignment]
    use_evidence: bool = True
    measures: Sequence[str] = ("maps",)
    along: ParameterAxis | None = None
    energy: float | tuple[float, ...] | None = None
    refine: int = 0
    section: Section = Section.Y_UP

    # `__init__` accepts more types than the fields have, and converts them. This declaration is for type checkers.
    if TYPE_CHECKING:

        def __init__(
            self,
            potential: Potential,
            plane: Slice | str,
            values: Sequence[float] | np.ndarray,
            resolution: Sequence[int] = DEFAULT_RESOLUTION,
            window: GivenWindow | None = None,
            t_max: float | None = None,
            use_evidence: bool = True,
            measures: Sequence[str] = ("maps",),
            along: ParameterAxis | None = None,
            energy: float | Sequence[float] | np.ndarray | None = None,
            refine: int = 0,
            section: Section | str = Section.Y_UP,
        ) -> None: ...

    def __post_init__(self) -> None:
        check_type("along", self.along, (ParameterAxis, type(None)))
        if (self.along is None) != (self.energy is None):
            raise ValueError(f"energy={short_repr(self.energy)}: must be given along a parameter, and None along the energy")
        if not isinstance(self.energy, numbers.Real | None):
            object.__setattr__(self, "energy", _checked_values("energy", self.energy))
        if self.along is not None:
            # This validates the parameter, which must belong to the system of the potential.
            MapSpec(self.potential, Slice(Coordinate.X, self.along), self.energies_at(self.along.high)[-1])
        plane, measures = _checked_plane(self.plane), _checked_measures(self.measures)
        values = _checked_values("values", self.values)
        refine = checked_count("refine", self.refine, 0, MOST_REFINED)
        if refine > 0 and "shares" not in measures:
            raise ValueError(f"refine={self.refine}: must be 0 without the measure 'shares', which decides where to refine")
        if "maps" in measures and self.along is not None and self.window is None:
            raise ValueError("window=None: must be given for maps along a parameter, which have common axes")
        # The map at the highest value checks the other fields and converts them.
        highest = MapSpec(
            self.potential, plane, self.energies_at(values[-1])[-1], self.resolution, self.window, self.t_max, self.use_evidence,
            section=self.section,
        )  # fmt: skip
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "measures", measures)
        for name in ("plane", "resolution", "window", "t_max", "use_evidence", "section"):
            object.__setattr__(self, name, getattr(highest, name))

    @property
    def count(self) -> int:
        """Number of values, including those of `refine`; a single value cannot be refined."""
        return len(self.values) + (self.refine if len(self.values) > 1 else 0)

    @property
    def map_count(self) -> int:
        """Number of maps, including those of `refine`."""
        return self.count * len(self.energies_at(self.values[-1]))

    @property
    def name(self) -> str:
        """The name of the varied quantity in datasets: "h", or the name of the parameter."""
        return "h" if self.along is None else self.along.key

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes whose shares are measured, besides bounded orbits."""
        if self.along is not None:
            return parameter_family(self.along).outcomes
        return self.potential.outcomes_at((self.values[0], self.values[-1]))

    def energies_at(self, value: float) -> tuple[float, ...]:
        """Return h of the maps at a value."""
        if isinstance(self.energy, tuple):
            return self.energy
        return (value if self.energy is None else self.energy,)

    def point(self, value: float, energy: float | None = None) -> SweepPoint:
        """Return the request for the measurement of one map; ValueError if the system has no potential at the value.

        `energy` is one of `energies_at` the value, by default the highest.
        """
        energy = self.energies_at(value)[-1] if energy is None else energy
        if self.along is None:
            potential, numbers = self.potential, tuple(range(len(self.potential.outcomes) + 1))
        else:
            member = parameter_family(self.along).member(value)
            potential, numbers = member.potential, tuple(member.numbers_at(energy).tolist())
        window = self._common_window()
        map_spec = MapSpec(
            potential, self.plane, energy, self.resolution, window, self.t_max, self.use_evidence, section=self.section
        )
        return SweepPoint(map_spec, self.name, value, tuple(self.measures), numbers, self.outcomes)

    def attributes(self) -> dict[str, Any]:
        """Return the request in plain values, with the integrator and the package version, as attributes of the dataset."""
        made_by = self.point(self.values[-1]).map_spec.provenance() | self.potential.provenance()
        if isinstance(self.energy, tuple):
            made_by["energy"] = list(self.energy)
        # Names of attributes that differ from map to map.
        differing = {"energy"} if self.along is None else {"terms"}
        if self._common_window() is None:
            differing |= {"window", "default_window"}
        along, system = "", None
        if self.along is not None:
            along, system = write_slice(Slice(Coordinate.X, self.along))[0], asdict(self.along.system)
        return {
            "result": "Sweep",
            **{name: value for name, value in made_by.items() if name not in differing},
            "axis": self.name,
            "symbol": "h" if self.along is None else self.along.symbol,
            "along": along,
            "along_system": json.dumps(system),
            "measures": ", ".join(self.measures),
            "outcomes": write_outcomes(self.outcomes),
            "requested": list(self.values),
            "refine": self.refine,
            "count": self.count,
        }

    def _common_window(self) -> GivenWindow | None:
        """Return the window of all maps; None if each map has its default window."""
        if self.window is None and "maps" in self.measures:
            return map_window(self.potential, self.plane, self.values[-1], self.resolution)
        return self.window


def _checked_plane(plane: Any) -> Slice:
    checked = checked_slice(plane)
    if checked.energy_axis is not None:
        raise ValueError(f"plane={checked.title}: must have no axis h, which already contains all energies")
    checked.check_one_potential("plane")
    return checked


def _checked_values(name: str, values: Any) -> tuple[float, ...]:
    """Return the values, sorted and made unique."""
    try:
        checked = tuple(sorted({float(value) for value in values}))
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name}={short_repr(values)}: must be a sequence of finite numbers") from None
    if not 1 <= len(checked) <= MOST_VALUES or not np.all(np.abs(checked) <= LARGEST_NUMBER):
        legal = f"1 to {MOST_VALUES} different numbers, each finite and at most {LARGEST_NUMBER:g} in magnitude"
        raise ValueError(f"{name}={short_repr(values)}: must be {legal}")
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
