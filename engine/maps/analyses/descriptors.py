"""Lagrangian descriptors of the starts of a map: integrals of a power of the speed along their orbits."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial
from typing import Any, ClassVar

import numpy as np

from engine.exits.exit_rows import exit_curves_at
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_number, checks_types
from engine.maps.analyses.map_analysis import analyse_map
from engine.maps.parameter_map import Place
from engine.maps.pixels import MirrorPixels, PixelAnalysis
from engine.maps.result import EscapeMap, MapLike, as_complete_map
from engine.maps.spec import MapSpec
from engine.maps.stages import OnChange, Stage
from engine.propagation.speed_integrals import integrate_speed
from engine.systems.potential import Potential

DEFAULT_DURATION = 10.0
"""Default τ in time units of the well: about one and a half periods of the motion in the well."""

# Number of parts into which the pixels are divided. The parts are computed one after the other, with a frame after each.
_PARTS = 16


class TimeDirection(StrEnum):
    """The directions of time over which a descriptor is integrated."""

    FORWARD = "forward"
    BACKWARD = "backward"
    BOTH = "both"


@dataclass(frozen=True, eq=False, repr=False)
class DescriptorMap(PixelAnalysis):
    """Lagrangian descriptors of the starts of a map, complete or in progress.

    Attributes
    ----------
    spec
        The map's request.
    descriptor
        (rows, columns) M = ``∫ |v|^p dt``, in units length^p time^(1 − p) of the potential; NaN for starts that are forbidden,
        outside or not computed yet, and for orbits whose steps become too short. Read-only.
    duration
        τ, dimensionless.
    power
        p.
    direction
        The directions of time of the integral.
    complete
        Whether all pixels are computed.
    """

    descriptor: np.ndarray
    duration: float
    power: float
    direction: TimeDirection
    pixel_arrays: ClassVar = {"descriptor": (np.float64, np.nan)}

    def __post_init__(self) -> None:
        super().__post_init__()
        # Files contain the direction as text.
        object.__setattr__(self, "direction", TimeDirection(self.direction))

    def describe(self) -> str:
        """Return the integral and its range in one sentence."""
        values = self.descriptor[np.isfinite(self.descriptor)]
        so_far = "" if self.complete else " so far"
        if not values.size:
            return f"No start has a Lagrangian descriptor{so_far}."
        limits = {TimeDirection.BOTH: "−τ to τ", TimeDirection.FORWARD: "0 to τ", TimeDirection.BACKWARD: "−τ to 0"}
        integral = (
            f"The Lagrangian descriptor ∫ |v|ᵖ dt, p = {self.power:g}, from {limits[self.direction]}, τ = {self.duration:g}"
        )
        return f"{integral}, at most up to an exit, lies between {values.min():.4g} and {values.max():.4g}{so_far}."


@shows_progress("Lagrangian descriptor")
@checks_types(on_frame=(Callable, type(None)), execution=Execution)
def compute_lagrangian_descriptor(
    escape_map: MapLike,
    *,
    duration: float | None = None,
    power: float = 0.5,
    direction: TimeDirection | str = TimeDirection.BOTH,
    on_frame: Callable[[DescriptorMap], None] | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> DescriptorMap:
    """Integrate M = ``∫ |v|^p dt`` along the orbit of each start of a complete map, over the time τ.

    ``|v|`` is the speed √(ẋ² + ẏ²) in the frame of the potential, which may rotate. M changes rapidly across the stable manifolds
    of unstable periodic orbits if integrated forward in time, and across the unstable manifolds if integrated backward.

    An integral ends where its orbit crosses an exit, collides or passes the escape radius. Beyond an exit the motion is
    unbounded: in most wells orbits reach infinity within a finite time, so the integral would diverge, and this motion gives no
    information on the well. Therefore M also jumps where orbits begin to escape within τ.

    Parameters
    ----------
    escape_map
        A complete map, or its dataset, such as ``dataset.sel(h=0.3)`` of a sweep.
    duration
        τ, above 0 and at most the largest t_max of `MapSpec`, dimensionless; None for 10 units of time of the well, see
        `Potential.units`.
    power
        p, above 0 and at most 1.
    direction
        ``"forward"`` from 0 to τ, ``"backward"`` from −τ to 0, or ``"both"``. For a map backward in time, "forward" is the past.
    on_frame
        Called in this thread with the result so far.
    execution
        How the computation runs. When it is cancelled, pixels not computed yet are NaN.

    Returns
    -------
    The `DescriptorMap`; equal to the bit for every executor. The relative error is about 1e-13 on regular orbits. Chaotic orbits
    and orbits that pass close to a body amplify rounding errors, to at most 1e-9 in tests with τ of 10 units of the well.

    Raises
    ------
    ValueError
        When the map is not complete, or a parameter is out of range.

    Notes
    -----
    Mancho, Wiggins, Curbelo & Mendoza 2013, Commun. Nonlinear Sci. Numer. Simul. 18, 3530, integrate any bounded positive
    property of orbits, among them powers of the modulus of the velocity. Lopesino, Balibrea-Iniesta, García-Garrido, Wiggins &
    Mancho 2017, Int. J. Bifurcation Chaos 27, 1730001, give the theory for another integrand, ``Σ |ẋ_i|^p`` over all coordinates,
    whose units differ between positions and momenta.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_lagrangian_descriptor, compute_map
    >>> escapes = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.45, (20, 20), t_max=100.0))
    >>> descriptors = compute_lagrangian_descriptor(escapes, duration=5.0)
    >>> round(float(descriptors.descriptor[10, 5]), 6)
    7.549268
    """
    escape_map = as_complete_map("escape_map", escape_map)
    choices = checked_choices(escape_map.spec.potential, duration, power, direction)

    def begin(pixels: EscapeMap, _place: Place) -> _DescriptorRun:
        return _DescriptorRun(pixels, **choices)

    return analyse_map(escape_map, begin, DescriptorMap, on_frame, execution, **choices)


def checked_choices(potential: Potential, duration: float | None, power: float, direction: TimeDirection | str) -> dict[str, Any]:
    """Return the parameters of `compute_lagrangian_descriptor` by name, with defaults; ValueError for a value out of range."""
    if duration is None:
        duration = DEFAULT_DURATION * potential.units.time
    return {
        "duration": potential.checked_t_max(duration, name="duration"),
        "power": _checked_power(power),
        "direction": _checked_direction(direction),
    }


def _checked_power(power: float) -> float:
    checked = checked_number("power", power, "above 0 and at most 1")
    if not 0.0 < checked <= 1.0:
        raise ValueError(f"power={power}: must be above 0 and at most 1")
    return checked


def _checked_direction(direction: TimeDirection | str) -> TimeDirection:
    if direction not in list(TimeDirection):
        raise ValueError(f"direction={direction!r}: must be one of {', '.join(TimeDirection)}")
    return TimeDirection(direction)


def _find_specs(spec: MapSpec, direction: TimeDirection) -> list[MapSpec]:
    """Return a request for each direction of time of the integral, in units of the well."""
    reversed_spec = replace(spec, backward=not spec.backward)
    specs = {
        TimeDirection.FORWARD: [spec],
        TimeDirection.BACKWARD: [reversed_spec],
        TimeDirection.BOTH: [spec, reversed_spec],
    }
    return [each.in_well_units() for each in specs[direction]]


class _DescriptorRun:
    """Computes the integrals of the pixels of a map of one potential, such as a line of a larger map, in units of the well."""

    def __init__(self, escape_map: EscapeMap, duration: float, power: float, direction: TimeDirection) -> None:
        self._given_spec, self._duration, self._power, self._direction = escape_map.spec, duration, power, direction
        self._map, self._specs = escape_map.in_well_units(), _find_specs(escape_map.spec, direction)
        self._mirror = MirrorPixels(self._map.spec, self._map.x, self._map.ordinate)
        self._pixels = self._mirror.find_first_images(np.flatnonzero(self._map.interior))
        self._values = np.full(self._map.fate.shape, np.nan)
        self._done_count = 0

    def stages(self, execution: Execution, _on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages, see `Staged`. Each stage computes a part of the pixels."""
        if not self._pixels.size:
            return
        for part in np.array_split(self._pixels, min(_PARTS, self._pixels.size)):
            yield partial(self._compute_part, part, execution)

    def _compute_part(self, part: np.ndarray, execution: Execution) -> None:
        """Compute the integrals of some pixels over all directions of time."""
        values = sum(self._integrate(spec, part, execution) for spec in self._specs)
        if not execution.is_cancelled:
            self._values.ravel()[part] = values
            self._done_count += part.size

    def _integrate(self, spec: MapSpec, part: np.ndarray, execution: Execution) -> np.ndarray:
        """Return the integrals of some pixels over one direction of time, in units of the well."""
        x, ordinate = self._map.coordinates(part)
        energies, curve_row = np.unique(spec.energies(x, ordinate), return_inverse=True)
        curves = exit_curves_at(spec.potential, energies)
        duration = self._duration / self._given_spec.potential.units.time
        states = spec.start_states(x, ordinate)
        return integrate_speed(spec.potential, curves, states, curve_row, duration, self._power, execution=execution)

    def progress(self) -> float:
        """Return the share of the pixels that are computed."""
        return self._done_count / max(self._pixels.size, 1)

    def frame(self) -> DescriptorMap:
        """Return the result so far."""
        units, power = self._given_spec.potential.units, self._power
        values = self._values * (units.length**power * units.time ** (1.0 - power))
        self._mirror.copy_to_second_images(values)
        complete = self._done_count == self._pixels.size
        return DescriptorMap(self._given_spec, values, self._duration, power, self._direction, complete=complete)
