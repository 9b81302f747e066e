"""What a potential is like, before anything is computed with it: its well, its saddles, what is missing, what is uncommon."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import lru_cache
from math import comb

import numpy as np

from engine.polynomials import HIGHEST_DEGREE
from engine.potentials.critical_points import NotIsolatedError, count_turns
from engine.potentials.formula_parser import COEFFICIENTS, LONGEST_TEXT, MOST_TERMS, write_formula
from engine.potentials.hill_region import find_bulging_channel, opens_below
from engine.potentials.potential import SAME_ENERGY, Potential
from engine.potentials.symmetry import count_rotations

MOST_CHANNELS = 16
"""Exits that the kernels of the search for Lyapunov orbits have room for."""

# Reviews of so many potentials are at hand.
_KEPT = 256
# A Hessian whose eigenvalues differ by more than this is singular for all that floating point can tell.
_SINGULAR = 1e-6
# The circle on which critical points are counted, in units of the distance of the outermost.
_CIRCLE = 4.0
# Saddles whose directions from the origin differ by less, in radians, cannot be told apart by direction.
_SAME_DIRECTION = 1e-3


class PointKind(Enum):
    """What a critical point is; the value is its name."""

    MINIMUM = "minimum"
    SADDLE = "saddle"
    MAXIMUM = "maximum"
    DEGENERATE = "degenerate point"


@dataclass(frozen=True)
class CriticalPoint:
    """A point where the force vanishes, at (x, y), of potential energy `energy`; `channel` is that which leads over it, or 0."""

    x: float
    y: float
    kind: PointKind
    energy: float
    channel: int


@dataclass(frozen=True)
class PotentialReview:
    """What `review_potential` found; lengths and energies are dimensionless.

    Attributes
    ----------
    potential
        The potential.
    critical_points
        All of them, nearest to the origin first; empty when they form a curve.
    escape_energy
        Energy of the lowest exit saddle; infinite when there is none.
    channels
        How many exits there are.
    highest_energy
        Up to here the exits stay apart: at the next critical energy, as at a maximum between two channels, what lies beyond them
        joins or another way opens. Infinite when there is none. Whether each Lyapunov orbit exists this high up is for
        `find_lyapunov_orbits` to say.
    mirror_in_x, mirror_in_y
        Whether V is even in x, in y.
    rotations
        The largest n for which a turn by 2π/n changes nothing; 1 when none does.
    refusal
        AnalysisPresenter nothing can be computed with it, in a sentence; None when all can.
    remarks
        What is out of the common, a sentence each.
    """

    potential: Potential
    critical_points: tuple[CriticalPoint, ...]
    escape_energy: float
    channels: int
    highest_energy: float
    mirror_in_x: bool
    mirror_in_y: bool
    rotations: int
    refusal: str | None
    remarks: tuple[str, ...]


@lru_cache(maxsize=_KEPT)
def review_potential(potential: Potential) -> PotentialReview:
    """Look a potential over, in about a second at the most, and at once when asked again: nothing is compiled or integrated.

    Parameters
    ----------
    potential
        Any.

    Returns
    -------
    The review; a potential that cannot be used has a `refusal`, and no error is raised.
    """
    points: tuple[CriticalPoint, ...] = ()
    refusal = _limits_refusal(potential)
    if refusal is None:
        try:
            points = _critical_points(potential)
            refusal = _refusal(potential, points)
        except NotIsolatedError:
            refusal = (
                "The force vanishes all along a curve, not at single points, as in a valley without end or a round potential: "
                "there is no well at the origin that single saddles close. Terms that make V rise in every direction are missing."
            )
    listed = bool(points)
    return PotentialReview(
        potential=potential,
        critical_points=points,
        escape_energy=potential.escape_energy if listed else float("inf"),
        channels=potential.channels if listed else 0,
        highest_energy=_highest_energy(potential, points),
        mirror_in_x=potential.mirror_in_x,
        mirror_in_y=potential.mirror_in_y,
        rotations=count_rotations(potential),
        refusal=refusal,
        remarks=() if refusal else _remarks(potential, points),
    )


def _critical_points(potential: Potential) -> tuple[CriticalPoint, ...]:
    places = potential.critical_points[np.argsort(np.hypot(*potential.critical_points.T), kind="stable")]
    return tuple(
        CriticalPoint(float(x), float(y), _kind(potential, x, y), float(potential.value(x, y)), _channel(potential, x, y))
        for x, y in places
    )


def _kind(potential: Potential, x: float, y: float) -> PointKind:
    vxx, vxy, vyy = potential.hessian(x, y)
    low, high = np.linalg.eigvalsh([[vxx, vxy], [vxy, vyy]])
    if min(abs(low), abs(high)) <= _SINGULAR * max(abs(low), abs(high)):
        return PointKind.DEGENERATE
    if low * high < 0.0:
        return PointKind.SADDLE
    return PointKind.MINIMUM if low > 0.0 else PointKind.MAXIMUM


def _channel(potential: Potential, x: float, y: float) -> int:
    near = np.flatnonzero(np.hypot(*(potential.saddles - [x, y]).T) < 1e-6 * potential.length)
    return int(near[0]) + 1 if near.size else 0


def _limits_refusal(potential: Potential) -> str | None:
    degree = max((i + j for i, j, _ in potential.terms), default=0)
    if degree > HIGHEST_DEGREE:
        return f"It is of degree {degree}; the highest degree is {HIGHEST_DEGREE}."
    if len(potential.terms) > MOST_TERMS:
        return f"It has {len(potential.terms)} terms; at most {MOST_TERMS} are possible."
    least, most = COEFFICIENTS
    if not all(least <= abs(c) <= most for _, _, c in potential.terms):
        return f"It has a coefficient whose size is outside {least:g} to {most:g}."
    return None


def _refusal(potential: Potential, points: tuple[CriticalPoint, ...]) -> str | None:
    """The first of all reasons to refuse a potential, in the order in which one would look."""
    for refusal in (_well_refusal, _points_refusal, _exits_refusal):
        sentence = refusal(potential, points)
        if sentence is not None:
            return sentence
    return None


def _well_refusal(potential: Potential, points: tuple[CriticalPoint, ...]) -> str | None:
    at_origin = next((point for point in points if point.x == point.y == 0.0), None)
    if at_origin is not None and at_origin.kind is PointKind.MINIMUM:
        return None
    if at_origin is None:
        problem = "There is no well at the origin: the force does not vanish there, since V has linear terms."
    else:
        problem = f"There is no well at the origin: V has a {at_origin.kind.value} there."
    minima = [point for point in points if point.kind is PointKind.MINIMUM]
    if len(minima) != 1:
        return f"{problem} Quadratic terms that make it a minimum are missing."
    x, y = minima[0].x, minima[0].y
    seen = write_formula(shifted(potential, x, y))
    hint = f"; seen from there V is {seen}" if len(seen) <= LONGEST_TEXT else ""
    return f"{problem} The one minimum lies at ({x:.6g}, {y:.6g}){hint}."


def _points_refusal(potential: Potential, points: tuple[CriticalPoint, ...]) -> str | None:
    for point in points:
        if point.kind is PointKind.DEGENERATE:
            return (
                f"V is flat to second order at ({point.x:.6g}, {point.y:.6g}): that is no saddle, minimum or maximum; whether "
                f"anything leaves over it cannot be told."
            )
    furthest = max(np.hypot(point.x, point.y) for point in points)
    saddles = sum(point.kind is PointKind.SADDLE for point in points)
    radius = _CIRCLE * (furthest if furthest > 0.0 else potential.length)
    if count_turns(potential.derivative(1, 0), potential.derivative(0, 1), radius) != len(points) - 2 * saddles:
        return "The points where the force vanishes could not all be found: their indices do not add up (Poincaré–Hopf theorem)."
    return None


def _exits_refusal(potential: Potential, points: tuple[CriticalPoint, ...]) -> str | None:
    furthest = max(np.hypot(point.x, point.y) for point in points) or potential.length
    if not potential.channels:
        reach = max(abs(point.energy - points[0].energy) for point in points) or potential.length**2
        if opens_below(potential, points[0].energy + 100.0 * reach, furthest):
            return "The well opens without a saddle: where its exits are, and above which energy, is not defined."
        return "No saddle leads out of the well at the origin: nothing leaves at any energy."
    if potential.channels > MOST_CHANNELS:
        return f"It has {potential.channels} channels; at most {MOST_CHANNELS} are possible."
    if opens_below(potential, potential.escape_energy, furthest):
        return "The well is open below its lowest saddle: what leaves that way crosses no exit."
    angles = np.sort(np.arctan2(potential.saddles[:, 1], potential.saddles[:, 0]))
    if potential.channels > 1 and np.diff(angles, append=angles[0] + 2.0 * np.pi).min() < _SAME_DIRECTION:
        return "Two exits lie in the same direction from the origin: which one an orbit leaves by could not be told."
    bulging = find_bulging_channel(potential)
    if bulging:
        return (
            f"The well reaches round the saddle of channel {bulging}: the line across it does not part inside from outside, "
            f"and which orbits have left could not be told."
        )
    return None


def _highest_energy(potential: Potential, points: tuple[CriticalPoint, ...]) -> float:
    if not points:
        return float("inf")
    margin = SAME_ENERGY * potential.length**2
    others = [point.energy for point in points if not point.channel and point.energy > potential.escape_energy + margin]
    return min(others, default=float("inf"))


def _remarks(potential: Potential, points: tuple[CriticalPoint, ...]) -> tuple[str, ...]:
    remarks = []
    energies = potential.saddle_energies
    if np.ptp(energies) > SAME_ENERGY * potential.length**2:
        order = np.argsort(energies, kind="stable")
        opened = ", ".join(f"{k + 1} above {energies[k]:.6g}" for k in order)
        remarks.append(f"The channels open one after the other: {opened}.")
    elsewhere = sum(point.kind is PointKind.SADDLE and not point.channel for point in points)
    if elsewhere:
        remarks.append(f"Saddles that do not lead out of the well at the origin, and so are no exits: {elsewhere}.")
    wells = [point for point in points if point.kind is PointKind.MINIMUM and (point.x or point.y)]
    if wells:
        where = ", ".join(f"({point.x:.6g}, {point.y:.6g})" for point in wells)
        remarks.append(
            f"There are other wells, at {where}: an orbit that has left into one counts as escaped, yet may come back."
        )
    highest = _highest_energy(potential, points)
    if np.isfinite(highest):
        remarks.append(f"The exits stay apart up to h = {highest:.6g}; above it the channels join or other ways open.")
    if not potential.mirror_in_y:
        remarks.append("V is not even in y: y = 0 is no line of symmetry, and an orbit may stay on one side of it.")
    if any(i + j == 0 for i, j, _ in potential.terms):
        remarks.append("The constant term moves no orbit; all energies are counted with it.")
    return tuple(remarks)


def shifted(potential: Potential, x: float, y: float) -> Potential:
    """A potential seen from its critical point (x, y): expanded there, without the constant and the linear terms."""
    table: dict[tuple[int, int], float] = {}
    for i, j, c in potential.terms:
        for k in range(i + 1):
            for m in range(j + 1):
                if k + m > 1:
                    part = c * comb(i, k) * comb(j, m) * x ** (i - k) * y ** (j - m)
                    table[k, m] = table.get((k, m), 0.0) + part
    largest = max(map(abs, table.values()), default=0.0)
    kept = ((k, m, float(f"{c:.12g}")) for (k, m), c in table.items() if abs(c) > 1e-12 * largest)
    return Potential(f"{potential.name}, shifted", tuple(kept))
