"""Escape maps of windows that double precision cannot resolve, in double-double arithmetic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from decimal import Decimal
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.dynamics.fates import Fate, name_fate
from engine.execution import DEFAULT_EXECUTION, Execution, run_parts, shows_progress
from engine.exits.exit_rows import exit_curves, exit_gates
from engine.exits.interior import find_outside_starts
from engine.maps.deep_starts import DeepStarts
from engine.maps.result import find_interior, outcome_shares, outcome_variables
from engine.maps.spec import MapSpec
from engine.potentials.well_units import TIME
from engine.results.result import MapResult
from engine.taylor.bound_kernels import load_deep_propagation
from engine.taylor.kernels.deep import DeepOrbits
from engine.taylor.source.deep_step import DEEP_ORDER, DEEP_TOLERANCE
from engine.taylor.source.recurrence import LANES
from engine.validation import checks_types, short_repr

if TYPE_CHECKING:
    import xarray as xr

FINEST_DEEP_PIXEL = 1e-29
"""Smallest distance of neighbouring pixels in units of the well: some hundred units in the last place of a pair."""

# Of decimal numbers: a fraction has as many digits.
_LARGEST_EXPONENT = 400
# Steps of lanes in a call, about 0.2 s: the interval of cancellation and progress.
_STEP_BUDGET = 20_000


@dataclass(frozen=True, eq=False, repr=False)
class DeepMap(MapResult):
    """An escape map in double-double arithmetic; arrays are read-only and of shape (rows, columns), with row 0 at the bottom.

    Attributes
    ----------
    spec
        The request, whose window is None.
    centre
        (abscissa, ordinate) of the centre, exact.
    width
        Width and height of the window.
    x, ordinate
        (columns,), (rows,) pixel centres as distances from `centre`.
    fate, escape_time, crossings, energy_error
        As in `Outcomes`; orbits that were not followed to their end are `Fate.NOT_COMPUTED`.
    complete
        Whether every pixel is decided.
    arithmetic
        "double-double".
    """

    spec: MapSpec
    centre: tuple[Fraction, Fraction]
    width: float
    x: np.ndarray
    ordinate: np.ndarray
    fate: np.ndarray
    escape_time: np.ndarray = field(metadata=TIME)
    crossings: np.ndarray
    energy_error: np.ndarray
    complete: bool
    arithmetic: str = "double-double"
    codes: ClassVar = {"fate": Fate}

    @property
    def interior(self) -> np.ndarray:
        """(rows, columns) bool, the pixels that are neither forbidden nor outside."""
        return find_interior(self.fate)

    def numbers(self) -> dict[str, Any]:
        """The request, and the share of each outcome among the interior starts."""
        outcomes = self.spec.outcomes
        shares = {name_fate(code, outcomes): share for code, share in outcome_shares(self.fate, outcomes).items()}
        made_by = {name: self.provenance()[name] for name in ("potential", "plane", "energy", "width", "arithmetic")}
        return made_by | {"t_max": self.spec.t_max} | shares | {"complete": self.complete}

    def provenance(self) -> dict[str, Any]:
        """How the map was made, in plain values: the request, the window, the integrator, the worst energy error."""
        # A deep map has no window in doubles.
        request = replace(self.spec, window=(0.0, 1.0, 0.0, 1.0)).provenance()
        errors = self.energy_error[np.isfinite(self.energy_error)]
        return {
            **{name: value for name, value in request.items() if name not in ("window", "default_window", "certify")},
            "centre": tuple(map(str, self.centre)),
            "width": self.width,
            "arithmetic": self.arithmetic,
            "integrator": f"Taylor series of order {DEEP_ORDER}, tolerance {DEEP_TOLERANCE:g}",
            "worst_energy_error": float(errors.max(initial=0.0)),
            "complete": int(self.complete),
        }

    def to_xarray(self) -> xr.Dataset:
        """The map as a dataset whose axes are distances from the centre."""
        import xarray as xr

        abscissa, ordinate = self.spec.plane.axis_names
        variables = outcome_variables(self.spec, self.fate, self.escape_time, self.crossings, self.energy_error)
        axes = {ordinate: self.ordinate, abscissa: self.x}
        coordinates = {name: (name, along, {"long_name": f"{name} minus that of the centre"}) for name, along in axes.items()}
        return xr.Dataset(variables, coordinates, {"result": "DeepMap", **self.provenance()})


@shows_progress("deep map")
@checks_types(spec=MapSpec, execution=Execution)
def compute_deep_map(spec: MapSpec, centre: Any, width: float, *, execution: Execution = DEFAULT_EXECUTION) -> DeepMap:
    """Compute an escape map of a window too small for double precision, with about 32 digits.

    Every number of the starts and of the integration is a pair of doubles. This takes 50 to 120 times as long as `compute_map`,
    so choose few pixels and a short t_max. Doubles in the request stand for simple numbers that round to them: fractions with
    denominators up to 10⁶, such as −1/3, or else their shortest decimals. There are no certificates.

    Parameters
    ----------
    spec
        The request: potential, slice, energy, resolution, t_max and direction of time. The potential is a polynomial at rest
        without centres; the axes of the slice are among x, y, px, py or directions in these. Its window must be None.
    centre
        (abscissa, ordinate) of the centre of the window: text such as "0.12345678901234567890123" or "1/3", or Fractions.
    width
        Width and height of the window, dimensionless, above 0; pixels must be at least 1e-29 units of the well apart.
    execution
        How the computation runs. When it is cancelled, orbits without a result stay `Fate.NOT_COMPUTED`.

    Raises
    ------
    ValueError
        If a parameter is invalid, or no exit is defined at the energy.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_deep_map
    >>> spec = MapSpec(CASES["III"], Plane.X_PX, 0.45, resolution=(4, 4), t_max=100.0)
    >>> deep = compute_deep_map(spec, ("0.1000000000000000000000001", "0.3"), 1e-24)
    >>> deep.complete, deep.fate.tolist()[0], bool(deep.energy_error.max() < 1e-28)
    (True, [1, 1, 1, 1], True)
    """
    starts, place = DeepStarts(spec), _checked_centre(centre)
    axes = [_offsets(width, count) for count in spec.resolution]
    _check_pixels(spec, axes)
    units, well = spec.potential.units, spec.potential.in_well_units
    states = starts.states(*([middle + offset for offset in axis] for middle, axis in zip(place, axes, strict=True)))
    orbits = _begin(states)
    energy = spec.common_energy / units.energy  # type: ignore[operator]
    curves = exit_curves(well, energy)
    allowed = np.flatnonzero(orbits.fate == Fate.NOT_COMPUTED)
    x, y = np.ascontiguousarray(states[allowed][:, [0, 4]].T)
    outside = find_outside_starts(well, x, y, np.full(x.size, energy), curves[None], np.zeros(x.size, np.int64))
    orbits.fate[allowed[outside > 0]] = Fate.OUTSIDE
    _propagate(orbits, starts, spec.t_max / units.time, curves, execution)
    return _collect(spec, place, float(width), axes, orbits, starts)


def _collect(
    spec: MapSpec,
    place: tuple[Fraction, Fraction],
    width: float,
    axes: Sequence[Sequence[Fraction]],
    orbits: DeepOrbits,
    starts: DeepStarts,
) -> DeepMap:
    """The map of orbits that have ended, or of a cancelled computation."""
    ended, escaped = orbits.fate >= Fate.BOUNDED, orbits.fate > 0
    errors = np.full(orbits.t.size, np.nan)
    errors[ended] = list(starts.energy_errors(orbits.state[ended]))
    shape = spec.resolution[::-1]
    x, ordinate = (np.array([float(offset) for offset in axis]) for axis in axes)
    found = DeepMap(
        spec, place, width, x, ordinate,
        fate=orbits.fate.reshape(shape),
        escape_time=np.where(escaped, orbits.exit_time, np.nan).reshape(shape),
        crossings=np.where(escaped, orbits.exit_crossings, orbits.crossings).astype(np.int32).reshape(shape),
        energy_error=errors.reshape(shape), complete=not bool(np.any(orbits.fate == Fate.NOT_COMPUTED)),
    )  # fmt: skip
    return spec.potential.units.restore(found)


def _checked_centre(centre: Any) -> tuple[Fraction, Fraction]:
    try:
        abscissa, ordinate = map(_exact, centre)
    except (TypeError, ValueError, ArithmeticError):
        raise ValueError(f"centre={short_repr(centre)}: must be two numbers as decimal text or Fractions") from None
    return abscissa, ordinate


def _exact(value: str | int | Fraction | Decimal) -> Fraction:
    """A number without rounding; TypeError for a float, which is rounded already."""
    if isinstance(value, float):
        raise TypeError
    if isinstance(value, str) and "/" not in value:
        value = Decimal(value)
    if isinstance(value, Decimal) and abs(value.adjusted()) > _LARGEST_EXPONENT:
        raise ValueError
    return Fraction(value)


def _offsets(width: Any, count: int) -> list[Fraction]:
    """Pixel centres from the middle of a window."""
    if not (isinstance(width, int | float) and 0.0 < width < math.inf):
        raise ValueError(f"width={short_repr(width)}: must be a finite number above 0")
    return [Fraction(repr(float(width))) * (2 * k + 1 - count) / (2 * count) for k in range(count)]


def _check_pixels(spec: MapSpec, axes: Sequence[Sequence[Fraction]]) -> None:
    for axis, unit in zip(axes, spec.plane.axis_units(spec.potential.units), strict=True):
        if len(axis) > 1 and axis[1] - axis[0] < FINEST_DEEP_PIXEL * unit:
            raise ValueError(
                f"width: pixels are {float(axis[1] - axis[0]):.2g} apart; must be {FINEST_DEEP_PIXEL * unit:.2g} or more"
            )
    if spec.window is not None:
        raise ValueError(f"spec.window={spec.window}: must be None; centre and width are the window of a deep map")


def _begin(states: np.ndarray) -> DeepOrbits:
    counts = np.zeros((3, len(states)), np.int64)
    fate = np.where(np.isfinite(states).all(axis=1), Fate.NOT_COMPUTED, Fate.FORBIDDEN).astype(np.int8)
    return DeepOrbits(states, np.zeros(len(states)), counts[0], counts[1], np.zeros(len(states)), counts[2], fate)


def _propagate(orbits: DeepOrbits, starts: DeepStarts, t_max: float, curves: np.ndarray, execution: Execution) -> None:
    """Follow all orbits without a fate to their ends, or until cancelled."""
    coefficients, total = starts.well_coefficients, int(np.count_nonzero(orbits.fate == Fate.NOT_COMPUTED))
    while (pending := np.flatnonzero(orbits.fate == Fate.NOT_COMPUTED)).size and not execution.is_cancelled:

        def select(part: np.ndarray) -> tuple[Any, ...]:
            return coefficients, DeepOrbits(*(array[part] for array in orbits)), t_max, curves

        for part, propagated in run_parts(_advance, pending, select, execution, least=LANES):
            for array, values in zip(orbits, propagated, strict=True):
                array[part] = values
        execution.report(partial(_share_done, orbits.fate, total))


def _share_done(fate: np.ndarray, total: int) -> float:
    return 1.0 - float(np.count_nonzero(fate == Fate.NOT_COMPUTED)) / total


def _advance(coefficients: dict[Any, Fraction], orbits: DeepOrbits, t_max: float, curves: np.ndarray) -> DeepOrbits:
    """Take some steps of orbits; runs in a worker."""
    propagate = load_deep_propagation(coefficients)
    propagate(np.arange(orbits.t.size), t_max, _STEP_BUDGET, curves, exit_gates(curves[None]), orbits)
    return orbits
