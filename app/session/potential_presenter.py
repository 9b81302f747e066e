"""Choice of the potential, which is reviewed in the background, shown with its properties, and used if it is valid."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.job_clients.latest_request import LatestRequest
from app.job_clients.parameter_shares import CHANGES, ParameterShares
from app.session.context import History, SessionContext
from app.state.system_review import PageReview, is_known, review_catalogue_entry, review_job
from app.views.analysis.potential_panel import NEW_INTEGRATOR, PotentialPanel
from app.views.maps.well import prepare_sketch, sketch_spec
from engine import MapSpec, Potential, System
from engine.jobs.job import Job, Queue
from engine.maps.warmup import is_ready_for_maps
from engine.systems.system import TYPED


@dataclass(frozen=True)
class _Proposal:
    """A system under review.

    Attributes
    ----------
    system
        The system.
    use
        Uses the review if the system is valid.
    refuse
        Says why the system cannot be used; None for a system of the panel, which shows the reason beside the text.
    done
        Whether the visitor has finished; False during typing or dragging.
    """

    system: System
    use: Callable[[PageReview], object]
    refuse: Callable[[str], None] | None = None
    done: bool = True


class PotentialPresenter:
    """Reviews each potential that is chosen, typed or set by a slider, and writes it to the view state if it is valid.

    All changes while a formula is typed, or a slider dragged, make one entry of the history.

    Parameters
    ----------
    context
        The session.
    history
        Numbers the entries of the browser's history.
    show_sketch
        Draws a potential that is typed and not used yet, or None.
    """

    def __init__(
        self, context: SessionContext, history: History, show_sketch: Callable[[MapSpec | None], None] = lambda spec: None
    ) -> None:
        state = self._state = context.state
        self._history = history
        self._proposal: _Proposal | None = None
        # The latest system that was proposed during a review.
        self._waiting_proposal: _Proposal | None = None
        self._last_review: PageReview | None = None
        self.panel = PotentialPanel(state.reviewed, context.locked(self._take), context.locked(self._request_shares))
        self._is_open = False
        self._shares = ParameterShares(state, context.jobs, self.panel.sliders.show_shares, context.locked)
        state.param.watch(lambda *events: self._end_shares(), list(CHANGES))
        self._request = LatestRequest(context.jobs, self._show, self._on_failure, context.locked)
        # The potential of the latest sketch, which ends with a text that cannot be used.
        self._sketched: Potential | None = None
        self._show_sketch = show_sketch
        self._sketch_request = LatestRequest(context.jobs, show_sketch, lambda sentence: None, context.locked)
        state.param.watch(lambda *events: self._follow_system(), "system")
        self.panel.show(state.reviewed)

    def open(self, system: System, use: Callable[[PageReview], object], refuse: Callable[[str], None]) -> bool:
        """Use or refuse the system of a link, a preset or the browser's history; return whether its review is awaited."""
        known = self._known_review(system)
        if known is not None and known.problem is None:
            self._cancel_link_review()
            use(known)
            return False
        self._propose(_Proposal(system, use, refuse))
        return self._proposal is not None

    def set_open(self, is_open: bool) -> None:
        """Follow whether the panel is on the page. Meanwhile, a slider shows shares of the outcomes, see `ParameterShares`."""
        if is_open != self._is_open:
            self._is_open = is_open
            self._end_shares()

    def _request_shares(self) -> None:
        """Compute the shares for the view at rest, unless the panel shows a system that is not used yet."""
        moved = self.panel.sliders.moved
        if self._is_open and moved is not None and self.panel.shown == self._state.system:
            self._shares.request(moved.name, moved.label, moved.low, moved.high)

    def _end_shares(self) -> None:
        """Show no shares until the panel is open and the view at rest."""
        self._shares.cancel()
        self.panel.sliders.clear_shares()

    def _cancel_link_review(self) -> None:
        """Cancel the review of an earlier link, but not the review of a system of the panel."""
        if self._proposal is not None and self._proposal.refuse is not None:
            self._proposal = None
            self._request.cancel()

    def _take(self, system: System, *, done: bool) -> None:
        """Review a system of the panel, after a running review. If each system cancelled it, no map could follow a drag."""
        proposal = _Proposal(system, self._use if done else self._use_if_ready, done=done)
        if self._proposal is None or self._proposal.refuse is not None:
            self._propose(proposal)
        else:
            self._waiting_proposal = proposal

    def _use_if_ready(self, reviewed: PageReview) -> None:
        """Use an unfinished system if its integrator is compiled, because a server can keep only some dozens of integrators."""
        if is_ready_for_maps(reviewed.potential):
            self._use(reviewed)
        else:
            self.panel.show(reviewed, NEW_INTEGRATOR)
            energy = self._energy_for(reviewed)
            spec = sketch_spec(reviewed.potential, reviewed.energies.first if energy is None else energy)
            self._sketched = reviewed.potential
            self._sketch_request.submit(Job(prepare_sketch, (spec,), queue=Queue.LONG_CALL))

    def _end_sketch(self) -> None:
        """Show the well of the view again, unless a map of the sketched potential follows."""
        if self._sketched is not None and self._sketched != self._state.potential:
            self._sketch_request.cancel()
            self._sketched = None
            self._show_sketch(None)

    def _use(self, reviewed: PageReview) -> None:
        """Show a valid system, and write it to the view state. An equal potential keeps energy, window and starts."""
        self.panel.used = reviewed
        self.panel.show(reviewed)
        if reviewed.system == self._state.system:
            self._end_sketch()
            return
        self._history.begin_gesture()
        if reviewed.potential == self._state.potential:
            self._state.show(reviewed)
        else:
            self._state.show_system(reviewed, self._energy_for(reviewed))

    def _propose(self, proposal: _Proposal) -> None:
        """Review a system, or show its known review."""
        self._proposal, self._waiting_proposal = proposal, None
        known = self._known_review(proposal.system)
        if known is not None:
            self._request.cancel()
            self._show(known)
        else:
            if proposal.refuse is None:
                self.panel.wait()
            self._request.submit(review_job(proposal.system))

    def _known_review(self, system: System) -> PageReview | None:
        if is_known(system):
            return review_catalogue_entry(system.case)
        reviews = (self._state.reviewed, self._last_review)
        return next((known for known in reviews if known is not None and known.system == system), None)

    def _on_failure(self, sentence: str) -> None:
        self._finish(lambda proposal: self._say(sentence) if proposal.refuse is None else proposal.refuse(sentence))

    def _say(self, sentence: str) -> None:
        self.panel.say(sentence)
        self._end_sketch()

    def _show(self, reviewed: PageReview) -> None:
        self._last_review = reviewed
        self._finish(lambda proposal: self._judge(proposal, reviewed))

    def _judge(self, proposal: _Proposal, reviewed: PageReview) -> None:
        if reviewed.problem is None:
            proposal.use(reviewed)
        elif proposal.refuse is None:
            self.panel.show(reviewed)
            self._end_sketch()
        else:
            proposal.refuse(reviewed.problem)

    def _finish(self, answer: Callable[[_Proposal], None]) -> None:
        """Pass the current proposal, if any, to `answer`, and continue with the waiting proposal."""
        proposal, self._proposal = self._proposal, None
        if proposal is None:
            return
        answer(proposal)
        if proposal.done:
            self._history.end_gesture()
        if self._waiting_proposal is not None:
            self._propose(self._waiting_proposal)

    def _energy_for(self, reviewed: PageReview) -> float | None:
        """Return the energy at the same multiple of the well's depth; None if that energy is too high, or the case is another."""
        previous, energies = self._state.reviewed, reviewed.energies
        if reviewed.system.case not in (TYPED, previous.system.case):
            return None
        if not previous.potential.escapes_over_saddles or not reviewed.potential.escapes_over_saddles:
            # Without exits the depth is undefined, so the energy itself is kept.
            return self._state.energy if energies.low <= self._state.energy <= energies.high else None
        well = previous.potential.well
        multiple = (self._state.energy - well.bottom) / well.depth
        energy = round(float(reviewed.potential.well.energy_at(multiple)), energies.decimals + 1)
        return energy if energy < reviewed.highest_energy else None

    def _follow_system(self) -> None:
        """Follow a system that the panel has not chosen, and cancel any review."""
        self._end_sketch()
        if self._state.reviewed is not self.panel.used:
            self._proposal = self._waiting_proposal = None
            self._request.cancel()
            self.panel.follow(self._state.reviewed)
