"""Another potential: looked over in the background, shown with what follows, and taken where nothing speaks against it."""

from __future__ import annotations

from app.job_clients.latest_request import LatestRequest
from app.job_clients.locking import Locked
from app.state.system import SYSTEM, TYPED, System, refusal
from app.state.view_state import ViewState
from app.views.analysis.potential_panel import PotentialPanel
from engine import CASES, Potential, PotentialReview, PotentialReviewAnswer, PotentialReviewRequest, Requests, review_potential


class PotentialPresenter:
    """One visitor's choice among all potentials; what they take goes to the view state."""

    def __init__(self, state: ViewState, jobs: Requests, locked: Locked) -> None:
        self._state = state
        self._proposed: tuple[System, bool] | None = None
        self._reviewed: dict[Potential, PotentialReview] = {}
        self.panel = PotentialPanel(self._look_at, self._take)
        self._request = LatestRequest(jobs, self._answered, self.panel.say, locked)
        state.param.watch(lambda *events: self._follow(), list(SYSTEM))
        self._follow()
        self.panel.section.open(state.case not in CASES or bool(state.system.changed))

    def open(self) -> None:
        """Show the choice, and what follows from the system in view."""
        self.panel.section.open(True)
        self._look_at(self._state.system)

    def close(self) -> None:
        """The session is over."""
        self._request.cancel()

    def _look_at(self, system: System) -> None:
        self._propose(system, take=False)

    def _take(self, system: System) -> None:
        if system != self._state.system:
            self._propose(system, take=True)

    def _propose(self, system: System, *, take: bool) -> None:
        """Have a system looked over, unless that has been done."""
        try:
            potential = system.potential
        except ValueError as error:
            self._request.cancel()
            self.panel.say(str(error))
            return
        # The last letter may be heard after Enter.
        self._proposed = system, take or self._proposed == (system, True)
        if potential in self._reviewed:
            self._show(self._reviewed[potential])
        else:
            self._request.ask(PotentialReviewRequest(potential))

    def _answered(self, answer: PotentialReviewAnswer) -> None:
        self._reviewed = {answer.review.potential: answer.review}
        self._show(answer.review)

    def _show(self, found: PotentialReview) -> None:
        if self._proposed is None:
            return
        system, take = self._proposed
        self._proposed = system, False
        problem = refusal(found)
        self.panel.show(found, problem)
        if take and problem is None:
            self._state.show_system(system, self._energy_for(system))
        elif take:
            self.panel.follow(self._state.system)

    def _energy_for(self, system: System) -> float | None:
        """Where only parameters change: as far above the escape energy as before."""
        before = self._state.system
        if (system.case, system.formula) != (before.case, before.formula):
            return None
        ratio = system.potential.escape_energy / before.potential.escape_energy
        return round(float(self._state.energy * ratio), system.energies.decimals + 1)

    def _follow(self) -> None:
        """Stand where the state stands."""
        system = self._state.system
        self.panel.follow(system)
        if system.case == TYPED or system.case not in CASES or system.changed:
            found = review_potential(system.potential)
            self.panel.show(found, refusal(found))
