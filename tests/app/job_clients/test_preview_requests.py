"""Under overload previews wait, and the latest energy is requested afterwards."""

from __future__ import annotations

from collections.abc import Callable

from app.job_clients.preview_requests import LoadPolicy, PreviewRequests
from app.state.view_state import ViewState
from engine.service import Jobs
from tests.app.job_clients.test_map_requests import Recorder


class Overload:
    """An overload that the test ends, and delayed calls that it runs."""

    def __init__(self) -> None:
        self.active = True
        self.delayed: list[Callable[[], None]] = []

    def policy(self) -> LoadPolicy:
        return LoadPolicy(lambda: self.active, self.delayed.append)

    def run_delayed(self) -> None:
        [call] = self.delayed
        self.delayed.clear()
        call()


def test_after_an_overload_the_latest_energy_is_requested() -> None:
    overload, recorder = Overload(), Recorder()
    state = ViewState(case="I", energy=0.3)
    previews = PreviewRequests(state, Jobs(), recorder.preview_arrived, lambda call: call, overload.policy())
    for energy in (0.31, 0.32, 0.33):
        previews.request(energy)
    overload.run_delayed()
    assert not previews.under_way
    overload.active = False
    overload.run_delayed()
    recorder.wait_for(lambda: bool(recorder.calls))
    assert [frame.spec.energy for _, frame in recorder.calls] == [0.33]


def test_a_cancelled_preview_is_not_requested_later() -> None:
    overload, recorder = Overload(), Recorder()
    previews = PreviewRequests(ViewState(case="I"), Jobs(), recorder.preview_arrived, lambda call: call, overload.policy())
    previews.request(0.31)
    previews.cancel()
    overload.active = False
    overload.run_delayed()
    assert not previews.under_way
