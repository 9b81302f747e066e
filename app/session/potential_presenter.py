"""Choice of the potential: validated in the background, shown with its properties, and used if it is valid."""

from __future__ import annotations

from app.job_clients.latest_request import LatestRequest
from app.job_clients.locking import Locked
from app.state.view_state import SYSTEM, ViewState
from app.views.analysis.potential_panel import PotentialPanel
from engine import CASES, Potential, PotentialReview
from engine.service import Answer, JobSubmitter, PotentialReviewRequest, System
from plots.accepted_potentials import refusal


class PotentialPresenter:
    """Potential of one session; a chosen valid potential goes to the view state."""

    def __init__(self, state: ViewState, jobs: JobSubmitter, locked: Locked) -> None:
        self._state = state
        # The system under review, and whether it is to be used.
        self._proposed: tuple[System, bool] | None = None
        self._reviews: dict[Potential, PotentialReview] = {}
        self.panel = PotentialPanel(locked(self._preview), locked(self._choose))
        self._request = LatestRequest(jobs, self._on_review, self.panel.say, locked)
        state.param.watch(lambda *events: self._follow(), list(SYSTEM))
        self.panel.section.open(state.case not in CASES or bool(state.system.changed))
        self._follow()

    def toggle(self) -> None:
        """Open the section with the properties of its system, or close it."""
        self.panel.section.open(not self.panel.section.is_open)
        if self.panel.section.is_open:
            self._preview(self.panel.shown)

    def close(self) -> None:
        """Cancel the request at the end of the session."""
        self._request.cancel()

    def _preview(self, system: System) -> None:
        self._propose(system, use=False)

    def _choose(self, system: System) -> None:
        self._propose(system, use=system != self._state.system)

    def _propose(self, system: System, *, use: bool) -> None:
        """Review a system, unless its review is cached; `use` shows it if it is valid."""
        try:
            potential = system.potential
        except ValueError as error:
            self._request.cancel()
            self._proposed = None
            self.panel.say(str(error))
            return
        # The event of the last letter may arrive after Enter.
        self._proposed = system, use or self._proposed == (system, True)
        if potential in self._reviews:
            self._show(self._reviews[potential])
        else:
            self._request.submit(PotentialReviewRequest(potential))

    def _on_review(self, answer: Answer[PotentialReview]) -> None:
        self._reviews = {answer.value.potential: answer.value}
        self._show(answer.value)

    def _show(self, review: PotentialReview) -> None:
        if self._proposed is None:
            return
        system, use = self._proposed
        self._proposed = system, False
        problem = refusal(review)
        if use and problem is None:
            self._state.show_system(system, self._energy_for(system))
        else:
            self.panel.show(review, problem)

    def _energy_for(self, system: System) -> float | None:
        """Energy in the same ratio to the escape energy as before; None for another potential."""
        before = self._state.system
        if (system.case, system.formula) != (before.case, before.formula):
            return None
        ratio = system.potential.escape_energy / before.potential.escape_energy
        return round(float(self._state.energy * ratio), system.energies.decimals + 1)

    def _follow(self) -> None:
        """Follow the view state."""
        self.panel.follow(self._state.system)
        if self.panel.section.is_open:
            self._preview(self._state.system)
