"""Curves against energy or a parameter: shares of the exits, islands, measures of the basins, escape times and their law."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.dynamics.fates import Fate
from engine.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.maps.spec import MapSpec
from engine.potentials.outcomes import Outcome, OutcomeKind
from engine.potentials.potential import Potential
from engine.results.codes import describe_codes
from engine.results.result import Result
from engine.slices.axes import Coordinate, ParameterAxis
from engine.slices.parameter_family import parameter_family
from engine.slices.slice import Slice
from engine.slices.slice_text import write_slice
from engine.sweeps.curve_points import CurvePoint, CurvePointSpec, compute_curve_point
from engine.sweeps.energy_grid import checked_sweep
from engine.validation import check_type, checked_count, checked_flag, checks_types, short_repr

if TYPE_CHECKING:
    import xarray as xr

MOST_VALUES = 1000
"""Most energies, or values of a parameter, of one sweep."""


@dataclass(frozen=True)
class CurvesSpec:
    """A sweep over energies, or over a parameter of the system, on one plane.

    The map at each value has the default window, which contains the whole interior.

    Parameters
    ----------
    potential
        The `Potential`; along a parameter, that of its system.
    plane
        A slice of one energy and one potential, such as (x, y) or (x, px).
    values
        Energies h, or values of the parameter; finite, dimensionless, 1 to 1000 of them; sorted and made unique.
    resolution
        (columns, rows) of the map at each energy.
    t_max
        Integration time, dimensionless, 0 < t_max ≤ 1e8.
    exponent
        Whether to compute the uncertainty exponent.
    along
        The parameter; None for the energy. Outcomes have the numbers of its `ParameterAxis`.
    energy
        h of all maps along a parameter; None otherwise.
    refine
        Number of further values, 0 to 1000, chosen while the curves are measured: each is the middle of the two neighbours
        between which the share of an exit, or of bounded starts, changes most.

    Raises
    ------
    ValueError
        Naming the parameter, its value and what is legal.
    """

    potential: Potential
    plane: Slice
    values: tuple[float, ...]
    resolution: tuple[int, int] = (112, 112)
    t_max: float = 1e5
    exponent: bool = True
    along: ParameterAxis | None = None
    energy: float | None = None
    refine: int = 0

    def __post_init__(self) -> None:
        plane, values = checked_sweep(self.plane, self.values, MOST_VALUES, "values")
        object.__setattr__(self, "plane", plane)
        object.__setattr__(self, "values", values)
        checked_count("refine", self.refine, 0, MOST_VALUES)
        checked_flag("exponent", self.exponent)
        check_type("along", self.along, (ParameterAxis, type(None)))
        if (self.along is None) != (self.energy is None):
            raise ValueError(f"energy={short_repr(self.energy)}: must be given along a parameter, and None along the energy")
        if self.along is not None:
            # Validates the parameter, which must be one of the system of the potential.
            MapSpec(self.potential, Slice(Coordinate.X, self.along), self.energy or 0.0)
        # Validates the other parameters.
        MapSpec(self.potential, self.plane, self._energy_at(values[0]), self.resolution, t_max=self.t_max)

    @property
    def count(self) -> int:
        """Number of values, those of `refine` included; a single value cannot be refined."""
        return len(self.values) + (self.refine if len(self.values) > 1 else 0)

    @property
    def name(self) -> str:
        """The name of what varies, in files: "h", or that of the parameter."""
        return "h" if self.along is None else self.along.key

    @property
    def symbol(self) -> str:
        """The symbol of what varies."""
        return "h" if self.along is None else self.along.symbol

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """What the curves are of, after bounded orbits."""
        if self.along is not None:
            return parameter_family(self.along).outcomes
        return self.potential.outcomes_at((min(self.values), max(self.values)))

    def point(self, value: float) -> CurvePointSpec:
        """The measurement at one value; ValueError if the system has no potential there."""
        potential, numbers = self.potential, tuple(range(len(self.potential.outcomes) + 1))
        if self.along is not None:
            member = parameter_family(self.along).member(value)
            potential, numbers = member.potential, tuple(member.numbers_at(self._energy_at(value)).tolist())
        map_spec = MapSpec(potential, self.plane, self._energy_at(value), self.resolution, t_max=self.t_max)
        return CurvePointSpec(map_spec, self.exponent, value, numbers, len(self.outcomes))

    def provenance(self) -> dict[str, Any]:
        """The request in plain values, with the integrator and the package version."""
        made_by = self.point(self.values[0]).map_spec.provenance()
        differing = ("energy", "window", "default_window") if self.along is None else ("window", "default_window", "terms")
        along, system = "", None
        if self.along is not None:
            along, system = write_slice(Slice(Coordinate.X, self.along))[0], asdict(self.along.system)
        return {
            **{name: value for name, value in made_by.items() if name not in differing},
            "requested": self.values,
            "exponent": int(self.exponent),
            "refine": self.refine,
            "along": along,
            "along_system": json.dumps(system),
        }

    def _energy_at(self, value: float) -> float:
        return value if self.energy is None else self.energy


_CURVES = tuple(field.name for field in fields(CurvePoint) if field.name not in ("value", "shares"))


@dataclass(frozen=True, eq=False)
class Curves(Result):
    """The points of a sweep measured so far, by ascending value."""

    spec: CurvesSpec
    points: tuple[CurvePoint, ...]

    def columns(self) -> Mapping[str, np.ndarray]:
        """All curves by name, the energy h or the parameter first; the share of bounded orbits is ``share_0``."""
        shares = {f"share_{code}": share for code, share in enumerate(self.shares.T)}
        return {self.spec.name: self.values, **shares, **{name: self.curve(name) for name in _CURVES}}

    @property
    def complete(self) -> bool:
        """Whether all values have been measured."""
        return len(self.points) == self.spec.count

    @property
    def nbytes(self) -> int:
        """Approximate size in bytes."""
        return sum(point.nbytes for point in self.points)

    @property
    def values(self) -> np.ndarray:
        """(n,) energies h of the points, or values of the parameter."""
        return np.array([point.value for point in self.points])

    @property
    def shares(self) -> np.ndarray:
        """(n, outcomes + 1) share of bounded orbits, then of each outcome."""
        return np.array([point.shares for point in self.points]).reshape(-1, len(self.spec.outcomes) + 1)

    def curve(self, name: str) -> np.ndarray:
        """(n,) any other attribute of `CurvePoint`, by its name."""
        return np.array([getattr(point, name) for point in self.points], dtype=float)

    def to_xarray(self) -> xr.Dataset:
        """All curves as a dataset with coordinates and provenance."""
        # Slow to import, and seldom used.
        import xarray as xr

        spec = self.spec
        variables: dict[str, Any] = {"share": ((spec.name, "fate"), self.shares)}
        variables |= {name: (spec.name, self.curve(name)) for name in _CURVES}
        labels = [outcome.label for outcome in spec.outcomes]
        fates = {} if all(outcome.kind is OutcomeKind.EXIT for outcome in spec.outcomes) else describe_codes(Fate, labels)
        coordinates = {spec.name: self.values, "fate": ("fate", np.arange(len(labels) + 1), fates)}
        return xr.Dataset(variables, coordinates, {"result": type(self).__name__, **spec.provenance()})


@shows_progress("curves")
@checks_types(
    spec=CurvesSpec,
    on_frame=(Callable, type(None)),
    execution=Execution,
    measure=(Callable, type(None)),
    earlier=(Curves, type(None)),
)
def compute_curves(
    spec: CurvesSpec,
    *,
    on_frame: Callable[[Curves], None] | None = None,
    execution: Execution = DEFAULT_EXECUTION,
    measure: Callable[[CurvePointSpec], CurvePoint] | None = None,
    earlier: Curves | None = None,
) -> Curves:
    """Measure exits and basins at many energies, or values of a parameter, in an order from coarse to fine.

    Parameters
    ----------
    spec
        The request.
    on_frame
        Called in this thread after each value with the points so far.
    execution
        How the computation runs.
    measure
        Replaces `compute_curve_point`, for example to use a cache; None to compute all values.
    earlier
        Curves whose points are not measured again, such as those of an interrupted call, which `on_frame` received, those of a
        file (`open_result`), or with fewer values; their request must be the same but for `values` and `refine`.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When no exit is defined at one of the values, or `earlier` is of another request.

    Examples
    --------
    >>> from escape_explorer import CASES, CurvesSpec, Plane, compute_curves
    >>> spec = CurvesSpec(CASES["III"], Plane.X_PX, (0.4, 0.5, 0.6), (40, 40), t_max=1e3, exponent=False)
    >>> compute_curves(spec).to_pandas()[["h", "share_1", "share_2"]].round(3)
         h  share_1  share_2
    0  0.4    0.354    0.354
    1  0.5    0.399    0.399
    2  0.6    0.441    0.441
    """
    points = _known_points(spec, earlier)
    curves = Curves(spec, tuple(points.values()))
    while (value := _next_value(spec, points)) is not None:
        point_spec = spec.point(value)
        part = execution.part(len(points), spec.count)
        points[value] = measure(point_spec) if measure is not None else compute_curve_point(point_spec, execution=part)
        curves = Curves(spec, tuple(points[each] for each in sorted(points)))
        if on_frame is not None:
            on_frame(curves)
        execution.report(lambda: len(points) / spec.count)
    return curves


def _known_points(spec: CurvesSpec, earlier: Curves | None) -> dict[float, CurvePoint]:
    """The points of earlier curves by their value, in ascending order: those of the values, and then some to refine them."""
    if earlier is None:
        return {}
    same = [each.name for each in fields(spec) if each.name not in ("values", "refine")]
    if differing := [name for name in same if getattr(earlier.spec, name) != getattr(spec, name)]:
        raise ValueError(f"earlier: its {', '.join(differing)} must be those of spec; only values and refine may differ")
    chosen = [point for point in earlier.points if point.value in spec.values]
    inside = [point for point in earlier.points if point.value not in spec.values]
    found = sorted([*chosen, *inside[: spec.count - len(spec.values)]], key=lambda point: point.value)
    return {point.value: point for point in found}


def _next_value(spec: CurvesSpec, points: Mapping[float, CurvePoint]) -> float | None:
    """The value to measure next: those of the request from coarse to fine, then where the shares change most; None at the end."""
    for index in _coarse_to_fine(len(spec.values)):
        if spec.values[index] not in points:
            return spec.values[index]
    if len(points) >= spec.count:
        return None
    values = sorted(points)
    shares = np.array([points[value].shares for value in values])
    changes = np.abs(np.diff(shares, axis=0)).max(axis=1)
    steepest = int(np.argmax(changes))
    return 0.5 * (values[steepest] + values[steepest + 1])


def _coarse_to_fine(count: int) -> list[int]:
    """0 to count − 1, ends first and then repeatedly the midpoints, so that the curves take shape early."""
    order, step = [0, count - 1] if count > 1 else [0], 1 << (count - 1).bit_length()
    while step > 1:
        step //= 2
        order += range(step, count, 2 * step)
    return list(dict.fromkeys(order))
