"""Search for super-sticky orbits: chaotic orbits that are bounded until t_max and escape long after (Zotos 2014, section 4.3).

Super-sticky orbits stay near the outermost invariant tori, move through chains of islands and cantori, and escape late, or not
within any practical integration time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine import EscapeMap, Fate, MapSpec, Regularity, classify_orbits
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.maps.pixels import MirrorPixels
from engine.results import RegularityMap


@dataclass(frozen=True, eq=False)
class SuperStickySearch:
    """The chaotic bounded starts of a map, integrated beyond its t_max.

    The starts are ordered row by row. In a symmetric map, both starts of a mirror pair are listed, but only the first is
    integrated: the second escapes at the same time through the mirrored exit.

    Attributes
    ----------
    spec
        The map's request.
    bounded_count
        Number of starts that are bounded until the map's t_max, whether regular, chaotic or undecided.
    x, ordinate
        Coordinates of the starts on the plane, each of shape (n,).
    states
        x, y, px, py of the starts, of shape (n, 4).
    fate, escape_time, crossings
        As in `engine.results.Outcomes`, each of shape (n,). The fate is `Fate.BOUNDED` for orbits that do not escape by `t_max`.
    is_mirror_symmetric
        Whether the map is symmetric under x → −x, so that mirror images share an integrated orbit.
    t_max
        Integration time of the orbits from the start, dimensionless.
    """

    spec: MapSpec
    bounded_count: int
    x: np.ndarray
    ordinate: np.ndarray
    states: np.ndarray
    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray
    is_mirror_symmetric: bool
    t_max: float

    @property
    def chaotic_share(self) -> float:
        """Share of the map's bounded starts that are chaotic; NaN if there are no bounded starts."""
        return self.fate.size / self.bounded_count if self.bounded_count else float("nan")

    @property
    def escapers(self) -> np.ndarray:
        """Array indices of the escaping orbits, of shape (m,), by escape time."""
        escapers = np.flatnonzero(self.fate >= 1)
        return escapers[np.argsort(self.escape_time[escapers], kind="stable")]

    def describe(self) -> str:
        """Describe the result in one or two sentences."""
        if not self.fate.size:
            return f"None of the {self.bounded_count} bounded starts is chaotic."
        counting = ", both mirror images counted" if self.is_mirror_symmetric else ""
        share = f"{100 * self.chaotic_share:.1f} %{counting}"
        sentence = f"{self.fate.size} of the {self.bounded_count} bounded starts are chaotic ({share})."
        return f"{sentence} {self._describe_escapers()}"

    def _describe_escapers(self) -> str:
        escapers = self.escapers
        if not escapers.size:
            return f"None of them escapes by t = {self.t_max:.4g}."
        channels, counts = np.unique(self.fate[escapers], return_counts=True)
        by_channel = ", ".join(f"{count} through exit {channel}" for channel, count in zip(channels, counts, strict=True))
        times = self.escape_time[escapers]
        return (
            f"{escapers.size} of them escape by t = {self.t_max:.4g} ({by_channel}): the first at t = {times[0]:.6g}, "
            f"half of these by {np.median(times):.6g}, the last at {times[-1]:.6g}."
        )


def find_super_sticky_orbits(
    escape_map: EscapeMap, regularity: RegularityMap, t_max: float, *, execution: Execution = DEFAULT_EXECUTION
) -> SuperStickySearch:
    """Integrate the chaotic bounded orbits of a map until they escape, or until a much longer t_max.

    Parameters
    ----------
    escape_map
        A complete map on a slice of one energy.
    regularity
        The complete result of `compute_regularity` for the same map.
    t_max
        Integration time from the start, dimensionless, above the map's t_max. The last orbit of Zotos (2014) escapes at 3.5e6.
    execution
        How the computation runs.

    Returns
    -------
    The search, equal to the bit for every executor. Over such long times, rounding errors grow to order 1: the escape time of
    each orbit depends on rounding, but the number of escapes hardly does.

    Raises
    ------
    ValueError
        If the map is on a slice with an axis h.
    concurrent.futures.CancelledError
        When cancelled.
    """
    spec = escape_map.spec
    if spec.common_energy is None:
        raise ValueError(f"escape_map: must be on a slice of one energy, not on {spec.plane.title}")
    pixels = np.flatnonzero(regularity.character.ravel() == Regularity.CHAOTIC)
    x, ordinate = escape_map.coordinates(pixels)
    states = spec.start_states(x, ordinate)
    mirror = MirrorPixels(spec, escape_map.x, escape_map.ordinate)
    first_pixels = mirror.find_first_images(pixels)
    is_integrated = np.isin(pixels, first_pixels)
    outcomes = classify_orbits(spec.potential, spec.common_energy, states[is_integrated], t_max, execution=execution)
    execution.raise_if_cancelled()
    # Index of the integrated orbit of each start: its own, or that of its mirror image.
    outcome_index = np.searchsorted(first_pixels, np.minimum(pixels, mirror.partner[pixels]))
    fate = outcomes.fate[outcome_index]
    if mirror.symmetric:
        fate = np.where(is_integrated, fate, spec.potential.well.mirror_fates[fate])
    return SuperStickySearch(
        spec=spec, bounded_count=int(np.count_nonzero(escape_map.fate == Fate.BOUNDED)),
        x=x, ordinate=ordinate, states=states, fate=fate, escape_time=outcomes.escape_time[outcome_index],
        crossings=outcomes.crossings[outcome_index], is_mirror_symmetric=mirror.symmetric, t_max=t_max,
    )  # fmt: skip
