"""The shares of the outcomes at values of a parameter, for the picture on the slider of the parameter."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from app.job_clients.latest_request import SKIPPED, LatestRequest, Locked
from app.state.system_review import PageReview, review_job
from app.state.view_state import ViewState
from engine import EscapeMap, Fate, MapSpec
from engine.foundations.wording import format_number
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Queue
from engine.maps.map_jobs import map_job
from engine.maps.warmup import is_ready_for_maps
from engine.sweeps.axes import coarse_to_fine
from engine.systems.outcomes import Outcome
from plots.pictures.palette import Palette

# Number of values, and columns and rows of the map at each value. All maps take 0.3 to 1 s of one core in the systems of the
# catalogue, and the reviews up to 4 s.
_VALUES = 17
_SIDE = 24
# Fates of allowed starts that reach no outcome, in the order of a stack of shares.
_FATES_INSIDE = (Fate.BOUNDED, Fate.NOT_COMPUTED, Fate.FAILED)

SHARES_HORIZON = 100.0
"""Integration time of the shares on all sliders, in units of the well."""

CHANGES = ("system", "plane", "section", "energy", "window", "palette")
"""Names of the parts of the view state on which the shares depend."""

Stack = list[tuple[str, int]]
"""The colours of the outcomes, from the top of a stack, and their numbers of starts."""


@dataclass(frozen=True)
class SliderShares:
    """The shares on the slider of a parameter.

    Attributes
    ----------
    name
        The parameter.
    title
        A sentence about the picture.
    columns
        Places along the slider, 0 to 1, with the stack of each. The stack of a value without a map is empty.
    """

    name: str
    title: str
    columns: tuple[tuple[float, Stack], ...]


class ParameterShares:
    """Computes coarse maps of the view at values of a parameter, one after the other, while nothing else is to be computed.

    The outcomes have the numbers and colours of the map that the page shows at the value. `ParameterAxis` would give exits the
    same number at all values, but finds no potentials beyond values at which exits change too often, such as 0 for the factor of
    a term without which exits are at infinity. A value remains without a map if its system has no potential or no exits there, or
    an integrator that is not compiled yet, because a server can keep only some dozens of integrators.

    Parameters
    ----------
    state
        The view state.
    jobs
        Computes reviews and maps.
    show
        Shows the values so far, under the session's lock.
    locked
        Wraps callbacks to run under the session's lock.
    """

    def __init__(self, state: ViewState, jobs: JobSubmitter, show: Callable[[SliderShares], None], locked: Locked) -> None:
        self._state, self._show = state, show
        self._shares = SliderShares("", "", ())
        self._spec: MapSpec | None = None
        # The places along the slider with the values of the parameter, the present one first.
        self._remaining: deque[tuple[float, float]] = deque()
        self._review_request = LatestRequest(jobs, self._take_review, self._leave_empty, locked)
        self._map_request = LatestRequest(jobs, self._take_map, self._leave_empty, locked, convert=_complete_only)

    def request(self, name: str, symbol: str, low: float, high: float) -> None:
        """Compute the shares on a slider, at both ends first, unless the view has several energies or potentials.

        Parameters
        ----------
        name, symbol
            Name and symbol of the parameter, which the system of the view has.
        low, high
            Values of the parameter at the ends of the slider, dimensionless.
        """
        self.cancel()
        state = self._state
        if state.plane.energy_axis is not None or state.plane.parameter is not None:
            return
        t_max = SHARES_HORIZON * state.potential.units.time
        self._spec = replace(state.map_spec(), resolution=(_SIDE, _SIDE), t_max=t_max)
        title = (
            f"Shares of coarse maps against {symbol} at h = {format_number(state.energy)}, t = {format_number(t_max)}; "
            "grey: still inside; empty: no map, or an integrator that is not compiled"
        )
        self._shares = SliderShares(name, title, ())
        places = coarse_to_fine(np.linspace(0.0, 1.0, _VALUES).tolist())
        self._remaining = deque((place, low + place * (high - low)) for place in places)
        self._continue()

    def cancel(self) -> None:
        """Compute no further values."""
        self._remaining.clear()
        self._review_request.cancel()
        self._map_request.cancel()

    def _continue(self) -> None:
        """Request the review of the system at the next value."""
        # Without this, a request would ignore a job that is equal to the previous one.
        self._review_request.cancel()
        self._map_request.cancel()
        if self._remaining:
            _, value = self._remaining[0]
            self._review_request.submit(review_job(self._state.system.with_parameter(self._shares.name, value)))

    def _take_review(self, reviewed: PageReview) -> None:
        assert self._spec is not None
        if reviewed.problem is not None or not is_ready_for_maps(reviewed.potential):
            self._leave_empty()
            return
        try:
            spec = replace(self._spec, potential=reviewed.potential)
        except ValueError:
            self._leave_empty()
        else:
            self._map_request.submit(map_job(spec, Queue.SPARE))

    def _take_map(self, escape_map: EscapeMap) -> None:
        spec = escape_map.spec
        self._add(_count_stack(escape_map.fate, self._state.colours, spec.potential.outcomes_at(spec.energy)))

    def _leave_empty(self, reason: str = "") -> None:
        self._add([])

    def _add(self, stack: Stack) -> None:
        """Show the stack of the present value, and go on to the next."""
        place, _ = self._remaining.popleft()
        self._shares = replace(self._shares, columns=(*self._shares.columns, (place, stack)))
        self._show(self._shares)
        self._continue()


def stack_colours(colours: Palette, outcomes: tuple[Outcome, ...]) -> list[tuple[int, str]]:
    """Return the fates of allowed starts and their colours, from the top of a stack of shares."""
    ends = enumerate((entry.colour for entry in colours.end_entries(outcomes)), 1)
    return [*ends, *((int(fate), colours.outcomes[fate].colour) for fate in _FATES_INSIDE)]


def _count_stack(fate: np.ndarray, colours: Palette, outcomes: tuple[Outcome, ...]) -> Stack:
    """Return the colours and numbers of the fates in a map, of any shape."""
    counts = Counter(fate.ravel().tolist())
    return [(colour, counts[code]) for code, colour in stack_colours(colours, outcomes)]


def _complete_only(escape_map: EscapeMap) -> object:
    return escape_map if escape_map.complete else SKIPPED
