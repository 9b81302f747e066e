"""Quick looks while others wait: none, and the latest wanted afterwards."""

from __future__ import annotations

from collections.abc import Callable

from app.job_clients.preview_requests import LoadPolicy, PreviewRequests
from app.state.view_state import ViewState
from engine import Jobs
from tests.app.job_clients.test_map_requests import Recorder


class Crowd:
    """Others who wait, and what is put off till later."""

    def __init__(self) -> None:
        self.here = True
        self.put_off: list[Callable[[], None]] = []

    def patience(self) -> LoadPolicy:
        return LoadPolicy(lambda: self.here, self.put_off.append)

    def time_passes(self) -> None:
        [call] = self.put_off
        self.put_off.clear()
        call()


def test_in_a_crowd_the_latest_wanted_comes_when_it_has_gone() -> None:
    crowd, recorder = Crowd(), Recorder()
    state = ViewState(case="I", energy=0.3)
    previews = PreviewRequests(state, Jobs(), recorder.preview_arrived, lambda call: call, crowd.patience())
    for energy in (0.31, 0.32, 0.33):
        previews.request(energy)
    crowd.time_passes()
    assert not previews.under_way
    crowd.here = False
    crowd.time_passes()
    recorder.wait_for(lambda: bool(recorder.told))
    assert [frame.spec.energy for _, frame in recorder.told] == [0.33]


def test_what_is_given_up_does_not_come_later() -> None:
    crowd, recorder = Crowd(), Recorder()
    previews = PreviewRequests(ViewState(case="I"), Jobs(), recorder.preview_arrived, lambda call: call, crowd.patience())
    previews.request(0.31)
    previews.cancel()
    crowd.here = False
    crowd.time_passes()
    assert not previews.under_way
