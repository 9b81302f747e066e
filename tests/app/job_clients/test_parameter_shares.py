"""The shares on the slider of a parameter are those of maps at its values, and are computed after everything else."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app.job_clients.parameter_shares import ParameterShares, SliderShares
from app.state.system_review import review_for_page
from app.state.view_state import ViewState
from engine import EscapeMap, Fate, Plane, System, compute_map
from engine.jobs.client import JobClient
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.jobs.subscription import Subscription
from engine.maps.warmup import prepare_for_maps
from engine.systems.system import TYPED
from tests.app.session.session_lock import locked_by
from tests.waiting import SECONDS

# Systems with the integrator of case I: at all values but 0, which is refused, and at 0 only.
QUOTIENT = System(TYPED, "½(x² + y²) − xy²/a")
OTHER_TERM = System(TYPED, "½(x² + y²) − xy² + a x^5 y")


class Session:
    """Shows shares, and waits for them."""

    def __init__(self, jobs: Any) -> None:
        self.state = ViewState(system=System("I"), energy=0.19)
        self.changed = threading.Condition()
        self.shown: list[SliderShares] = []
        self.shares = ParameterShares(self.state, jobs, self.shown.append, locked_by(self.changed))

    def columns(self, name: str, low: float, high: float) -> dict[float, list[tuple[str, int]]]:
        """Return the stacks at all values."""
        with self.changed:
            self.shares.request(name, name, low, high)
            assert self.changed.wait_for(lambda: bool(self.shown) and len(self.shown[-1].columns) == 17, SECONDS)
        return {low + place * (high - low): stack for place, stack in self.shown[-1].columns}


@pytest.fixture
def session() -> Iterator[Session]:
    prepare_for_maps(System("I").potential)
    client = JobClient(Jobs())
    yield Session(client)
    client.close()


def test_shares_are_those_of_maps_at_the_values_from_coarse_to_fine(session: Session) -> None:
    session.state.plane = Plane.X_Y
    columns = session.columns("epsilon", 0.2, 2.0)
    [*places] = columns
    assert places[:3] == [0.2, 2.0, 1.1]
    potential = System("I").with_parameter("epsilon", places[2]).potential
    fate = compute_map(replace(session.state.map_spec(), potential=potential, resolution=(24, 24), t_max=100.0)).fate
    palette = session.state.colours
    expected = {palette.channels[k]: int(np.sum(fate == k + 1)) for k in range(2)}
    counts = Counter[str]()
    for colour, count in columns[places[2]]:
        counts[colour] += count
    assert {colour: counts[colour] for colour in expected} == expected
    assert min(expected.values()) > 0
    assert counts.total() == np.sum(~np.isin(fate, (Fate.FORBIDDEN, Fate.OUTSIDE)))
    assert session.shown[-1].title.startswith("Shares of coarse maps against epsilon at h = 0.19, t = 100;")


@pytest.mark.parametrize(("system", "empty_at_0"), [(QUOTIENT, True), (OTHER_TERM, False)])
def test_values_without_a_potential_or_a_compiled_integrator_stay_empty(
    session: Session, system: System, empty_at_0: bool
) -> None:
    session.state.show_system(review_for_page(system), 0.19)
    columns = session.columns("a", -2.0, 2.0)
    assert {value for value, stack in columns.items() if not stack} == ({0.0} if empty_at_0 else set(columns) - {0.0})


class RecordedJobs:
    """Records requests and cancellations; the test delivers results."""

    def __init__(self) -> None:
        self.jobs: list[Job[Any]] = []
        self.cancelled: list[Job[Any]] = []
        self.deliver: Callable[[Any], None] = lambda result: None

    def request(self, job: Any, on_result: Callable[[Any], None], on_error: Callable[[Exception], None]) -> Subscription:
        self.jobs.append(job)
        self.deliver = on_result
        return Subscription(lambda subscription: self.cancelled.append(job), on_result, on_error)


def test_maps_go_after_everything_else_and_end_when_they_are_cancelled() -> None:
    prepare_for_maps(System("I").potential)
    jobs = RecordedJobs()
    session = Session(jobs)
    session.shares.request("epsilon", "ε", 0.5, 2.0)
    jobs.deliver(review_for_page(System("I").with_parameter("epsilon", 0.5)))
    assert jobs.jobs[-1].queue is Queue.SPARE
    [spec] = jobs.jobs[-1].arguments
    session.shares.cancel()
    jobs.deliver(compute_map(spec))
    assert (session.shown, len(jobs.jobs), jobs.cancelled[-1]) == ([], 2, jobs.jobs[-1])


def test_frames_of_maps_count_when_they_are_complete() -> None:
    prepare_for_maps(System("I").potential)
    jobs = RecordedJobs()
    session = Session(jobs)
    session.shares.request("epsilon", "ε", 1.0, 2.0)
    jobs.deliver(review_for_page(System("I").with_parameter("epsilon", 1.0)))
    deliver, [spec] = jobs.deliver, jobs.jobs[-1].arguments
    frames: list[EscapeMap] = []
    compute_map(replace(spec, t_max=1e3), on_frame=frames.append)
    assert not frames[0].complete
    deliver(frames[0])
    assert not session.shown
    deliver(frames[-1])
    assert len(session.shown[-1].columns) == 1


def test_a_view_of_several_energies_has_no_shares() -> None:
    jobs = RecordedJobs()
    session = Session(jobs)
    session.state.plane = Plane.X_H
    session.shares.request("epsilon", "ε", 0.5, 2.0)
    assert not jobs.jobs
