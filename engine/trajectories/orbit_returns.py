"""Returns of orbits of one energy, given by their starts, to the surface of section."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from engine.exits.exit_rows import exit_curves
from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checks_types
from engine.propagation.fates import Fate
from engine.propagation.followed_orbits import FollowedOrbits, checked_returns
from engine.slices.sections.section import Section
from engine.slices.sections.section_text import checked_section
from engine.systems.outcomes import Outcome
from engine.systems.potential import Potential
from engine.trajectories.classified_orbits import checked_states_of_energy
from engine.trajectories.trajectory import SectionResult

# Least number of orbits that are followed at once, which keep all threads busy.
_PART_SIZE = 1000


@dataclass(frozen=True, eq=False, repr=False)
class OrbitReturns(SectionResult):
    """The first crossings of a section by n orbits, not counting the starts, as returned by `find_returns`.

    Attributes
    ----------
    fate
        (n,) int8 codes of how each orbit ended: k ≥ 1 for the outcome ``outcomes[k - 1]``, or a `Fate`. `Fate.NOT_COMPUTED` for
        an orbit with all returns, which was followed to the last one only, and for one that was not followed. Read-only.
    count
        (n,) number of returns of each orbit. Read-only.
    states
        (returns, n, 4) x, y, px, py at each return; NaN for missing returns. Read-only.
    time
        (returns, n) time of each return; NaN for missing returns. Read-only.
    outcomes
        The outcomes of the potential at the energy of the orbits.
    section
        The surface of section.
    """

    fate: np.ndarray
    count: np.ndarray
    states: np.ndarray
    time: np.ndarray
    outcomes: tuple[Outcome, ...] = ()
    codes: ClassVar = {"fate": Fate}
    row_dimension: ClassVar = "orbit"
    array_dimensions: ClassVar = {"states": ("return", "orbit", "coordinate"), "time": ("return", "orbit")}

    def points(self) -> list[np.ndarray]:
        """Return the returns of each orbit that returns, (m, 2), in the order of the orbits and of time, see `Section.axes`."""
        return self.section.axes.points_of_orbits(self.states)

    @property
    def fates_of_points(self) -> np.ndarray:
        """The fate of each orbit that returns, in the order of `points`."""
        return self.fate[self.count > 0]

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return fate and number of returns of each orbit."""
        return {"fate": self.fate, "count": self.count}


@shows_progress("orbits")
@checks_types(potential=Potential, execution=Execution)
def find_returns(
    potential: Potential,
    energy: float,
    states: Any,
    returns: int = 1,
    t_max: float | None = None,
    *,
    section: Section | str = Section.Y_UP,
    execution: Execution = DEFAULT_EXECUTION,
) -> OrbitReturns:
    """Follow orbits of one energy from given starts to their first crossings of a surface of section.

    For all starts of a map, see `compute_returns`.

    Parameters
    ----------
    potential
        The potential.
    energy
        h, finite, at most 1e9 in magnitude, dimensionless.
    states
        (n, 4) x, y, px, py; finite, with this energy to within 1e-9 in units of the well. A start on the section is not counted.
    returns
        Largest number of returns of each orbit, 1 to 100 000; at most 5 million of all orbits.
    t_max
        Longest time, 0 < t_max ≤ 1e8, dimensionless; by default as in `MapSpec`.
    section
        The surface of section: a `Section` or text, see `read_section`.
    execution
        How the computation runs. When it is cancelled, orbits not followed yet have no returns.

    Returns
    -------
    The `OrbitReturns`. Returns end where an orbit escapes or collides, or at t_max. Equal to the bit for every executor.

    Raises
    ------
    ValueError
        If a state is not finite or has another energy, a parameter is out of range, or `section` is not legal.

    Examples
    --------
    >>> from escape_explorer import POTENTIALS, find_returns
    >>> potential = POTENTIALS["HH"]
    >>> px = (2 / 12 - 2 * potential.value(0.0, 0.1)) ** 0.5
    >>> found = find_returns(potential, 1 / 12, [[0.0, 0.1, px, 0.0]], returns=3, section="x = 0, px > 0")
    >>> found.states.shape, found.time[:, 0].round(3).tolist()
    ((3, 1, 4), [6.312, 12.626, 18.722])
    """
    array = checked_states_of_energy(potential, energy, states)
    checked_returns(returns, len(array))
    t_max, section = potential.checked_t_max(t_max), checked_section(section)
    units, well = potential.units, potential.in_well_units
    orbits = FollowedOrbits(
        well, array / units.state, np.zeros(len(array), np.int64), exit_curves(well, energy / units.energy)[None], returns,
        t_max / units.time, section.in_well_units(units).numbers,
    )  # fmt: skip
    for part in orbits.parts(execution, _PART_SIZE):
        if execution.is_cancelled:
            break
        orbits.follow(part, execution)
        execution.report(orbits.share_done)
    found, time = section.restore_returns(orbits.points, units)
    made_by = potential.describe_run(energy=float(energy), t_max=t_max, section=section.text)
    return OrbitReturns(
        read_only(orbits.fate), read_only(np.isfinite(time).sum(axis=0)), read_only(found), read_only(time),
        potential.outcomes_at(energy), section=section, made_by=made_by,
    )  # fmt: skip
