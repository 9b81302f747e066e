"""Super-sticky orbits: chaotic orbits that are still bounded at t_max and escape long after (Zotos 2014, section 4.3).

They stay near the outermost invariant tori, move through chains of islands and cantori, and escape late or not within any
practical integration time.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from engine.dynamics.batch import OrbitBatch, propagate_batch
from engine.dynamics.classification import collect_outcomes
from engine.dynamics.fates import Fate, Regularity, outcome_of
from engine.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.exits.exit_rows import exit_curves
from engine.maps.pixels import MirrorPixels
from engine.maps.regularity import RegularityMap
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.potentials.outcomes import OutcomeKind
from engine.potentials.well_units import TIME
from engine.results.arrays import read_only
from engine.results.result import Result


@dataclass(frozen=True, eq=False, repr=False)
class SuperStickySearch(Result):
    """The chaotic bounded starts of a map, integrated beyond its t_max; arrays are read-only and share one length n.

    The starts are ordered row by row. If the map is mirror symmetric, both mirror images are listed but only one of each pair
    was integrated: the other escapes at the same time through the opposite channel.

    Attributes
    ----------
    spec
        The map's request.
    bounded
        Number of starts that are bounded until the map's t_max, regular ones included.
    x, ordinate
        (n,) coordinates of the starts on the plane.
    states
        (n, 4) x, y, px, py of the starts.
    fate, escape_time, crossings
        (n,) as in `engine.Outcomes`, counted from the start; `Fate.BOUNDED` for orbits that do not escape by `t_max`.
    images
        Number of starts per integrated orbit: 2 for a mirror symmetric map, else 1.
    t_max
        Integration time, dimensionless.
    """

    spec: MapSpec
    bounded: int
    x: np.ndarray
    ordinate: np.ndarray
    states: np.ndarray
    fate: np.ndarray
    escape_time: np.ndarray = field(metadata=TIME)
    crossings: np.ndarray
    images: int
    t_max: float = field(metadata=TIME)

    @property
    def chaotic_share(self) -> float:
        """Share of the map's bounded starts that are chaotic; NaN if there are no bounded starts."""
        return self.fate.size / self.bounded if self.bounded else float("nan")

    @property
    def escapers(self) -> np.ndarray:
        """(m,) array indices of the orbits that escape, in order of escape time."""
        escaped = np.flatnonzero(self.fate >= 1)
        in_order: np.ndarray = escaped[np.argsort(self.escape_time[escaped], kind="stable")]
        return in_order

    def describe(self) -> str:
        """The result in two sentences."""
        if not self.fate.size:
            return f"None of the {self.bounded} bounded starts is chaotic."
        counted = ", both mirror images counted" if self.images > 1 else ""
        found = f"{self.fate.size} of the {self.bounded} bounded starts are chaotic ({100 * self.chaotic_share:.1f} %{counted})."
        return f"{found} {self._describe_escapers()}"

    def _describe_escapers(self) -> str:
        escapers = self.escapers
        if not escapers.size:
            return f"None of them leaves by t = {self.t_max:.4g}."
        fates, counts = np.unique(self.fate[escapers], return_counts=True)
        ends = [outcome_of(fate, self.spec.outcomes) for fate in fates.tolist()]
        by_end = ", ".join(
            f"{count} {'through ' if end.kind is OutcomeKind.EXIT else ''}{end.label}"
            for end, count in zip(ends, counts, strict=True)
        )
        times = self.escape_time[escapers]
        return (
            f"{escapers.size} of them leave by t = {self.t_max:.4g} ({by_end}): the first at t = {times[0]:.6g}, "
            f"half of these by {np.median(times):.6g}, the last at {times[-1]:.6g}."
        )


@shows_progress("super-sticky orbits")
def find_super_sticky_orbits(
    escape_map: EscapeMap,
    regularity: RegularityMap,
    t_max: float,
    *,
    execution: Execution = DEFAULT_EXECUTION,
) -> SuperStickySearch:
    """Integrate the chaotic bounded orbits of a map until they escape or a much longer t_max.

    Parameters
    ----------
    escape_map
        A complete map on a slice of one energy.
    regularity
        The complete result of `compute_regularity` for the same map.
    t_max
        Integration time from the start, dimensionless, at least t_max of the map and at most 1e8. The last orbit of Zotos (2014)
        escapes at 3.5e6.
    execution
        How the computation runs.

    Returns
    -------
    `SuperStickySearch`, bit-identical for every executor. At such times rounding errors have grown to order 1: which orbit
    escapes when is arbitrary, but how many escape is not.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When the map or the regularity is not complete, they belong to different maps, the map has an axis h, or `t_max` is out of
        range.
    """
    _check(escape_map, regularity, t_max)
    given_spec, units = escape_map.spec, escape_map.spec.potential.units
    found = _search(escape_map.in_well_units(), regularity, t_max / units.time, execution)
    states = read_only(found.states * units.state)
    return replace(given_spec.plane.restore(found, units), spec=given_spec, states=states)


def _search(escape_map: EscapeMap, regularity: RegularityMap, t_max: float, execution: Execution) -> SuperStickySearch:
    """`find_super_sticky_orbits` in units of the well."""
    spec = escape_map.spec
    pixels = np.flatnonzero(regularity.character.ravel() == Regularity.CHAOTIC)
    x, ordinate = escape_map.coordinates(pixels)
    states = spec.start_states(x, ordinate)
    mirror = MirrorPixels(spec, escape_map.x, escape_map.ordinate)
    partner = mirror.partner[pixels]
    batch = OrbitBatch.from_starts(states, np.zeros(pixels.size, np.int64))
    _propagate(spec, batch, np.flatnonzero(pixels <= partner), t_max, execution)
    if mirror.symmetric:
        firsts = np.flatnonzero(pixels < partner)
        batch.copy_to_images(
            firsts,
            np.searchsorted(pixels, partner[firsts]),
            spec.potential.well.mirror_numbers(spec.energies(x, ordinate)[firsts]),
        )
    outcomes = collect_outcomes(spec.potential, spec.energies(x, ordinate), batch)
    return SuperStickySearch(
        spec,
        int(np.count_nonzero(escape_map.fate == Fate.BOUNDED)),
        read_only(x),
        read_only(ordinate),
        read_only(states),
        read_only(outcomes.fate),
        read_only(outcomes.escape_time),
        read_only(outcomes.crossings),
        images=2 if mirror.symmetric else 1,
        t_max=float(t_max),
    )


def _propagate(
    spec: MapSpec,
    batch: OrbitBatch,
    which: np.ndarray,
    t_max: float,
    execution: Execution,
) -> None:
    """Integrate the orbits `which` of a batch to t_max; raises CancelledError when cancelled."""

    def progress() -> float:
        covered = np.where(batch.fate[which] == Fate.NOT_COMPUTED, np.minimum(batch.t[which] / t_max, 1.0), 1.0)
        return float(covered.mean())

    assert spec.common_energy is not None
    curves = exit_curves(spec.potential, spec.common_energy)[None]
    propagate_batch(
        spec.potential, curves, batch, which, t_max, final=True, execution=execution, on_tiles=lambda: execution.report(progress)
    )
    execution.raise_if_cancelled()


def _check(escape_map: EscapeMap, regularity: RegularityMap, t_max: float) -> None:
    escape_map.check_complete("escape_map")
    escape_map.spec.plane.check_one_potential("escape_map")
    if escape_map.spec.common_energy is None:
        raise ValueError(f"escape_map: is on {escape_map.spec.plane.title}; must be on a slice without an axis h")
    if regularity.spec != escape_map.spec or not regularity.complete:
        raise ValueError("regularity: must be complete and of the same map")
    if escape_map.spec.potential.checked_t_max(t_max) < escape_map.spec.t_max:
        raise ValueError(f"t_max={t_max}: must be at least the t_max of the map, {escape_map.spec.t_max:g}")
