"""The section of the potential asks for shares on the slider of one parameter while it is open and the view is at rest."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from app.session.context import History
from app.session.potential_presenter import PotentialPresenter
from app.state.view_state import ViewState
from engine import System, Window
from engine.jobs.manager import Jobs
from tests.app.browser_messages import send
from tests.app.job_clients.test_parameter_shares import RecordedJobs
from tests.app.session.session_lock import context_of


class Session:
    """The section of the potential, whose jobs are recorded."""

    def __init__(self) -> None:
        self.state, self.jobs = ViewState(system=System("I"), energy=0.19), RecordedJobs()
        context = replace(context_of(self.state, Jobs(), threading.Condition()), jobs=self.jobs)
        self.presenter = PotentialPresenter(context, History())
        self.sliders = self.presenter.panel.sliders

    def rest(self) -> None:
        send(self.sliders, {"rest": self.sliders.strip["count"]})


@pytest.fixture
def session() -> Session:
    return Session()


def reviewed_systems(session: Session) -> list[Any]:
    return [job.arguments[0] for job in session.jobs.jobs]


def test_nothing_is_computed_while_the_section_is_closed(session: Session) -> None:
    session.rest()
    session.presenter.set_open(True)
    session.presenter.set_open(False)
    session.rest()
    assert not session.jobs.jobs


def test_the_parameter_that_was_moved_last_or_the_first_has_the_shares(session: Session) -> None:
    session.presenter.set_open(True)
    session.rest()
    assert reviewed_systems(session) == [System("I").with_parameter("omega_1", 0.2)]
    send(session.sliders, {"name": "epsilon", "value": 1.0, "count": 1, "done": True})
    session.rest()
    assert reviewed_systems(session)[-1] == System("I").with_parameter("epsilon", 0.2)


CHANGES: dict[str, Callable[[Session], Any]] = {
    "energy": lambda session: session.state.param.update(energy=0.2),
    "window": lambda session: session.state.param.update(window=Window(-0.1, 0.1, -0.1, 0.1)),
    "system": lambda session: session.state.param.update(system=System("II")),
    "section closed": lambda session: session.presenter.set_open(False),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=list(CHANGES))
def test_a_change_of_the_view_cancels_the_shares_until_it_is_at_rest_again(
    session: Session, change: Callable[[Session], Any]
) -> None:
    session.presenter.set_open(True)
    session.rest()
    before = session.sliders.strip["count"]
    change(session)
    assert session.jobs.cancelled == session.jobs.jobs
    assert session.sliders.strip["count"] > before
    # A message about the earlier view comes too late.
    send(session.sliders, {"rest": before})
    assert len(session.jobs.jobs) == 1
