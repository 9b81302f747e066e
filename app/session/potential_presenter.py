"""Choice of the potential: reviewed in the background, shown with its properties, and used if it is valid."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.job_clients.latest_request import LatestRequest
from app.job_clients.locking import Locked
from app.state.system_review import SystemReview, is_known, review_catalogue_entry, review_system
from app.state.view_state import SYSTEM, ViewState
from app.views.analysis.potential_panel import PotentialPanel
from engine.service import Job, JobSubmitter, Queue, System


@dataclass(frozen=True)
class _Proposal:
    """A system under review.

    Attributes
    ----------
    system
        The system.
    use
        Called with the review of a valid system; None if only its properties are shown.
    refuse
        Called with the reason if it cannot be used; None if it stands beside the text.
    """

    system: System
    use: Callable[[SystemReview], object] | None = None
    refuse: Callable[[str], None] | None = None


class PotentialPresenter:
    """Potential of one session; a chosen valid potential goes to the view state."""

    def __init__(self, state: ViewState, jobs: JobSubmitter, locked: Locked) -> None:
        self._state = state
        self._proposal: _Proposal | None = None
        self._last: SystemReview | None = None
        self.panel = PotentialPanel(state.reviewed, locked(self._preview), locked(self._choose))
        self._request = LatestRequest(jobs, self._on_review, self._on_failure, locked)
        state.param.watch(lambda *events: self._follow(), list(SYSTEM))
        self._follow()

    def toggle(self) -> None:
        """Open the section with the properties of its system, or close it."""
        self.panel.section.open(not self.panel.section.is_open)
        if self.panel.section.is_open:
            self._preview(self.panel.shown)

    def open(self, system: System, use: Callable[[SystemReview], object], refuse: Callable[[str], None]) -> bool:
        """Use the system of a link, a preset or the browser's history, or refuse it; returns whether it is under review."""
        known = self._known_review(system)
        if known is not None and known.problem is None:
            self._drop_opened()
            use(known)
            return False
        self._propose(_Proposal(system, use, refuse))
        return True

    def _drop_opened(self) -> None:
        """Cancel the review of an earlier link; that of a text that is being typed goes on."""
        if self._proposal is not None and self._proposal.refuse is not None:
            self._proposal = None
            self._request.cancel()

    def close(self) -> None:
        """Cancel the request at the end of the session."""
        self._request.cancel()

    def _preview(self, system: System) -> None:
        # The event of the last letter may arrive after Enter.
        if self._proposal is None or self._proposal.system != system:
            self._propose(_Proposal(system))

    def _choose(self, system: System) -> None:
        use = None if system == self._state.system else lambda reviewed: self._use(reviewed)
        self._propose(_Proposal(system, use))

    def _use(self, reviewed: SystemReview) -> None:
        self._state.show_system(reviewed, self._energy_for(reviewed))

    def _propose(self, proposal: _Proposal) -> None:
        """Review a system, unless its review is known."""
        self._proposal = proposal
        known = self._known_review(proposal.system)
        if known is not None:
            self._request.cancel()
            self._show(known)
        else:
            if proposal.refuse is None:
                self.panel.wait()
            self._request.submit(Job(review_system, (proposal.system,), queue=Queue.LONG_CALL))

    def _known_review(self, system: System) -> SystemReview | None:
        if is_known(system):
            return review_catalogue_entry(system.case)
        return next((known for known in (self._state.reviewed, self._last) if known is not None and known.system == system), None)

    def _on_review(self, reviewed: SystemReview) -> None:
        self._last = reviewed
        self._show(reviewed)

    def _on_failure(self, sentence: str) -> None:
        proposal, self._proposal = self._proposal, None
        if proposal is not None and proposal.refuse is not None:
            proposal.refuse(sentence)
        else:
            self.panel.say(sentence)

    def _show(self, reviewed: SystemReview) -> None:
        proposal, self._proposal = self._proposal, None
        if proposal is None:
            return
        if reviewed.problem is not None and proposal.refuse is not None:
            proposal.refuse(reviewed.problem)
        elif reviewed.problem is None and proposal.use is not None:
            proposal.use(reviewed)
        else:
            self.panel.show(reviewed.review, reviewed.problem)

    def _energy_for(self, reviewed: SystemReview) -> float | None:
        """Energy in the same ratio to the escape energy as before; None for another potential."""
        before, system = self._state.reviewed, reviewed.system
        if (system.case, system.formula) != (before.system.case, before.system.formula) or reviewed.energies is None:
            return None
        ratio = reviewed.review.escape_energy / before.review.escape_energy
        return round(float(self._state.energy * ratio), reviewed.energies.decimals + 1)

    def _follow(self) -> None:
        """Follow the view state; a system that is still under review comes too late."""
        self._proposal = None
        self._request.cancel()
        self.panel.follow(self._state.reviewed)
        if self.panel.section.is_open:
            self._preview(self._state.system)
