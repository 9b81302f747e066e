"""Close an orbit: correct its returns to a section by Newton's method until the orbit is periodic.

The unknowns are the states at the nodes, the times between the n returns of a period, and the value of the parameter of a family,
such as the energy. The returns are nodes, and further nodes divide the time between two returns evenly. Each part of the orbit
must end where the next part begins, the returns must be on the section, and the orbit must have the energy of the value (multiple
shooting; Stoer & Bulirsch 2002, Introduction to Numerical Analysis, section 7.3.5). Errors grow over one part only, so very
unstable orbits are found as well. All quantities are in units of the well, and the value is in the unit of the parameter.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from engine.exits.closed_orbit import Nodes
from engine.exits.saddle_orbits.orbit_parts import Parts, trace_parts, velocities
from engine.integrator.kernels.dense_output import sample_path
from engine.periodic.family_parameter import Conditions, FamilyParameter, NoPotentialError
from engine.slices.sections.section import Crossing, Section
from engine.systems.potential import Potential

# Largest number of corrections, and of those that are larger than the correction before.
_MOST_CORRECTIONS, _MOST_GROWTHS = 15, 2
# Largest correction of an unknown at once, relative to the size of the orbit. A larger correction is shortened.
_LARGEST_CORRECTION = 0.3
# Size below which corrections that no longer decrease are rounding errors.
_TOLERANCE = 1e-9
# Residual after which one more correction suffices. Near a bifurcation, the corrections themselves stay large.
_SMALL_RESIDUAL = 1e-12
# Largest distance between the ends of neighbouring parts of a closed orbit.
_LARGEST_GAP = 1e-10
# Smallest period of an orbit.
_SHORTEST_PERIOD = 1e-6
# Growth of an error along a part above which the part is divided, and largest number of parts between two returns.
_LARGEST_GROWTH, _MOST_PARTS = 100.0, 32


SINGULAR = 1e-10
"""Share of the largest singular value below which others are 0: at a bifurcation, a direction of the orbit is not fixed."""


class Trial(NamedTuple):
    """A closed orbit, or a trial orbit.

    Attributes
    ----------
    states
        (nodes, 4) x, y, px, py at the nodes.
    durations
        (n,) times from each return to the next one.
    value
        The value of the parameter, see `engine.periodic.family_parameter`: the energy h if this is the parameter.
    parts
        (n,) numbers of parts between each return and the next one.
    """

    states: np.ndarray
    durations: np.ndarray
    value: float
    parts: tuple[int, ...]

    @property
    def returns(self) -> np.ndarray:
        """(n,) indices of the nodes that are returns."""
        return np.concatenate([[0], np.cumsum(self.parts)[:-1]])

    @property
    def owners(self) -> np.ndarray:
        """(nodes,) number of the return, from 0, before or at each node."""
        return np.repeat(np.arange(len(self.parts)), self.parts)

    @property
    def part_durations(self) -> np.ndarray:
        """(nodes,) durations of the parts."""
        return np.repeat(self.durations / self.parts, self.parts)

    @property
    def nodes(self) -> Nodes:
        """The states at the nodes, with the durations of the parts."""
        return Nodes(self.states, self.part_durations)

    @property
    def vector(self) -> np.ndarray:
        """(4 nodes + n + 1,) all unknowns."""
        return np.concatenate([self.states.ravel(), self.durations, [self.value]])

    @property
    def is_of_returns(self) -> np.ndarray:
        """(4 nodes + n + 1,) whether an unknown is not that of a node between two returns."""
        is_return = np.isin(np.arange(len(self.states)), self.returns)
        return np.concatenate([np.repeat(is_return, 4), np.ones(len(self.durations) + 1, bool)])

    @property
    def numbers(self) -> np.ndarray:
        """(5 n + 1,) the unknowns without those of nodes between two returns."""
        return self.vector[self.is_of_returns]

    def moved(self, vector: np.ndarray) -> Trial:
        """Return the trial orbit with other unknowns."""
        size = self.states.size
        return self._replace(states=vector[:size].reshape(-1, 4), durations=vector[size:-1], value=float(vector[-1]))

    def shortened(self, returns: int) -> Trial:
        """Return the trial orbit with the first returns only."""
        nodes = sum(self.parts[:returns])
        return self._replace(states=self.states[:nodes], durations=self.durations[:returns], parts=self.parts[:returns])

    def repeated(self, count: int) -> Trial:
        """Return the orbit traversed several times."""
        return self._replace(
            states=np.tile(self.states, (count, 1)), durations=np.tile(self.durations, count), parts=self.parts * count
        )


class Equations(NamedTuple):
    """The linearised equations of a trial orbit.

    Attributes
    ----------
    jacobian
        (m, m) derivatives of the residual by the unknowns, the last of which is the value of the parameter.
    residual
        (m,) gaps between the parts, distances of the returns from the section, and error of the energy.
    """

    jacobian: np.ndarray
    residual: np.ndarray


def linearise(parameter: FamilyParameter, trial: Trial) -> Equations | None:
    """Return the equations of a trial orbit; None if it cannot be integrated.

    Parameters
    ----------
    parameter
        The parameter.
    trial
        The trial orbit.
    """
    try:
        conditions = parameter.at(trial.value)
        by_value = parameter.derivative(trial.value, trial.vector.size, lambda others: _residual(others, trial))
    except NoPotentialError:
        return None
    parts = _traced(conditions, trial)
    if parts is None:
        return None
    residual = _residual_of_parts(conditions, trial, parts)
    jacobian = np.column_stack([_jacobian(conditions, trial, parts), by_value])
    return Equations(jacobian, residual) if np.isfinite(residual).all() and np.isfinite(jacobian).all() else None


def _traced(conditions: Conditions, trial: Trial) -> Parts | None:
    """Return the parts of a trial orbit; None if it cannot be integrated."""
    return trace_parts(conditions.potential, trial.states, trial.part_durations)


def _residual(conditions: Conditions, trial: Trial) -> np.ndarray:
    """Return the residual of a trial orbit, (m,); NaN if it cannot be integrated."""
    parts = _traced(conditions, trial)
    return np.full(trial.vector.size, np.nan) if parts is None else _residual_of_parts(conditions, trial, parts)


def _residual_of_parts(conditions: Conditions, trial: Trial, parts: Parts) -> np.ndarray:
    """Return the residual of a trial orbit with these parts."""
    potential, section, energy = conditions
    distances = section.values(trial.states[trial.returns])
    return np.concatenate([parts.gaps(trial.states), distances, [potential.energy(trial.states[0]) - energy]])


def _jacobian(conditions: Conditions, trial: Trial, parts: Parts) -> np.ndarray:
    """Return the derivatives of the residual by the states and the times, (m, m − 1)."""
    potential, section, _ = conditions
    states, gaps, returns, owners = trial.states, trial.states.size, trial.returns, trial.owners
    jacobian = np.zeros((gaps + len(returns) + 1, gaps + len(returns)))
    jacobian[:gaps, :gaps] = parts.changes_of_gaps()
    changes = velocities(potential, parts.ends) / np.array(trial.parts)[owners, None]
    jacobian[np.arange(gaps), gaps + np.repeat(owners, 4)] = changes.ravel()
    for row, k in enumerate(returns, gaps):
        jacobian[row, 4 * k : 4 * k + 4] = section.rates(states[k], np.eye(4))
    x, y, px, py = states[0]
    jacobian[-1, :4] = *potential.gradient(x, y), px, py
    return jacobian


def close_orbit(
    parameter: FamilyParameter, trial: Trial, direction: np.ndarray | None = None, singular: float = SINGULAR
) -> tuple[Trial, Equations] | None:
    """Return the closed orbit near a trial orbit with its equations; None if the corrections do not converge.

    Parameters
    ----------
    parameter, trial
        See `linearise`.
    direction
        Direction in the space of unknowns in which the orbit is not corrected; None to keep the value of the parameter.
    singular
        Share of the largest singular value below which a singular value counts as 0: the orbit is not corrected in its direction.
    """
    vector, previous_size, scale, growths = trial.vector, np.inf, _scale_of(trial), 0
    if direction is None:
        direction = np.zeros(vector.size)
        direction[-1] = 1.0
    # Trial orbits that diverge are rejected.
    with np.errstate(all="ignore"):
        for _ in range(_MOST_CORRECTIONS):
            equations = linearise(parameter, trial.moved(vector))
            if equations is None:
                return None
            # The shortest solution of these equations has no part along the direction.
            across = equations.jacobian - np.outer(equations.jacobian @ direction, direction)
            correction = -np.linalg.lstsq(across, equations.residual, rcond=singular)[0]
            size = float(np.abs(correction).max())
            vector = vector + correction * min(1.0, _LARGEST_CORRECTION * scale / max(size, np.finfo(float).tiny))
            is_accurate = float(np.abs(equations.residual).max()) < _SMALL_RESIDUAL * scale
            if is_accurate or (size < _TOLERANCE * scale and size >= 0.1 * previous_size):
                return _checked(parameter, trial.moved(vector))
            growths += size > previous_size
            if growths > _MOST_GROWTHS:
                return None
            previous_size = size
    return None


def _checked(parameter: FamilyParameter, trial: Trial) -> tuple[Trial, Equations] | None:
    """Return a corrected orbit with its equations; None if its parts do not join within `_LARGEST_GAP`.

    A state after a time of 0 solves the equations as well, but is not an orbit.
    """
    equations = linearise(parameter, trial)
    if equations is None or trial.durations.sum() < _SHORTEST_PERIOD:
        return None
    # `not … <` also rejects NaN.
    if not np.abs(equations.residual).max() < _LARGEST_GAP * _scale_of(trial):
        return None
    return trial, equations


def _scale_of(trial: Trial) -> float:
    """Return the size of an orbit, by which tolerances are multiplied if it is larger than the unit of the well."""
    return max(1.0, float(np.abs(trial.states).max()))


def crosses_section(potential: Potential, section: Section, orbit: Trial) -> bool:
    """Return whether all returns of an orbit cross the section in its direction, and do not only touch it.

    A state within `_LARGEST_GAP` of an equilibrium closes after any time, but is no orbit.
    """
    states = orbit.states[orbit.returns]
    rates = section.rates(states, velocities(potential, states))
    if section.direction is Crossing.BOTH:
        rates = np.abs(rates)
    return bool(np.all(rates > _LARGEST_GAP))


def with_parts(potential: Potential, orbit: Trial, parts: tuple[int, ...]) -> Trial | None:
    """Return an orbit without nodes between its returns with numbers of parts instead; None if it cannot be integrated."""
    found = trace_parts(potential, orbit.states, orbit.durations)
    if found is None:
        return None
    nodes = [
        sample_path(potential.well.kernels, steps, np.arange(count) * (duration / count)).T
        for steps, duration, count in zip(found.steps, orbit.durations, parts, strict=True)
    ]
    return orbit._replace(states=np.concatenate(nodes), parts=parts)


def divided(potential: Potential, trial: Trial) -> Trial:
    """Return a trial orbit with further nodes where errors grow much between two returns. Other nodes stay where they are."""
    found = trace_parts(potential, trial.states, trial.part_durations)
    if found is None:
        return trial
    growths = np.maximum(np.abs(found.matrices).max(axis=(1, 2)), 1.0)
    wanted = np.maximum(np.ceil(np.log(growths) / math.log(_LARGEST_GROWTH)), 1).astype(int)
    # All parts between two returns take the same time.
    factors = np.minimum(np.maximum.reduceat(wanted, trial.returns), np.maximum(_MOST_PARTS // np.array(trial.parts), 1))
    states = []
    for steps, duration, factor in zip(found.steps, trial.part_durations, factors[trial.owners], strict=True):
        states += list(sample_path(potential.well.kernels, steps, np.arange(factor) * (duration / factor)).T)
    parts = tuple(int(factor) * count for factor, count in zip(factors, trial.parts, strict=True))
    return trial._replace(states=np.array(states), parts=parts)
