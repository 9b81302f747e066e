"""The player of many orbits follows and changes the view state, and gets the decay rate of motion that mixes."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest

from app.state.system_review import review_catalogue_entry
from app.state.view import Analysis
from app.state.view_state import ViewState
from app.state.watched_starts import StartsFrom, WatchedStarts
from app.views.orbits.ensemble_player import EnsemblePlayer
from engine import CASES, Coordinate, ParameterAxis, Plane, Slice, System, compute_flux
from engine.jobs.manager import Jobs
from engine.maps.warmup import prepare_for_maps
from tests.app.browser_messages import send
from tests.app.session.session_lock import context_of
from tests.disc import disc_map
from tests.waiting import SECONDS


class Session:
    """The parts of a session that the player needs."""

    def __init__(self, jobs: Jobs, **chosen: Any) -> None:
        self.changed = threading.Condition()
        self.state = ViewState(system=System("III"), energy=0.45, analysis=Analysis.WATCH, **chosen)
        self.context = context_of(self.state, jobs, self.changed)
        self.player = EnsemblePlayer(self.state, self.context.results, self.context.jobs, self.context.locked)

    def send(self, **choice: Any) -> None:
        send(self.player, {"where": "view", "count": 1000, "seed": 4, "radius": -3, **choice})


@pytest.fixture(scope="module")
def jobs() -> Jobs:
    return Jobs()


@pytest.fixture
def session(jobs: Jobs) -> Iterator[Session]:
    made = Session(jobs, starts=((0.1, 0.2), (0.3, 0.1)), chosen=1)
    yield made
    made.context.jobs.close()


@pytest.mark.parametrize(
    ("case", "missing"), [("III", set[str]()), ("Earth-Moon", {"tubes"}), ("Copenhagen", {"exits", "tubes"})]
)
def test_starts_are_offered_where_a_system_has_them(session: Session, case: str, missing: set[str]) -> None:
    session.state.watched = WatchedStarts(StartsFrom.TUBES)
    session.state.show_system(review_catalogue_entry(case))
    assert session.player.where == (StartsFrom.WELL if "tubes" in missing else StartsFrom.TUBES)
    assert set(StartsFrom) - set(session.player.places) == missing


def test_the_player_has_the_choices_of_the_state(session: Session) -> None:
    session.state.watched = WatchedStarts(StartsFrom.DISC, 20000, 7, -4.5)
    player = session.player
    assert (player.where, player.count, player.seed, player.radius) == ("disc", 20000, 7, -4.5)
    assert player.point == [0.3, 0.1]
    session.state.starts = ()
    assert player.point == []


def test_choices_of_the_browser_change_the_state_and_other_messages_nothing(session: Session) -> None:
    wrong = [{"where": "moon"}, {"count": 7}, {"seed": -1}, {"radius": 3}, {"radius": None}, {"count": "1"}]
    for change in wrong:
        session.send(**change)
    assert session.state.watched == WatchedStarts()
    session.send()
    assert session.state.watched == WatchedStarts(StartsFrom.VIEW, 1000, 4, -3.0)


def test_the_player_is_closed_from_the_browser(session: Session) -> None:
    send(session.player, {"closed": False})
    assert session.state.analysis == Analysis.WATCH
    send(session.player, {"closed": True})
    assert session.state.analysis == Analysis.ORBIT


def test_each_press_changes_the_player(session: Session) -> None:
    before = session.player.presses
    session.player.press()
    session.player.press()
    assert session.player.presses == before + 2


def test_the_player_gets_the_rate_of_mixed_motion_where_starts_share_energy_and_parameters(session: Session) -> None:
    prepare_for_maps(CASES["III"])
    expected = compute_flux(CASES["III"], 0.45).decay_rate
    with session.changed:
        session.context.results.frame = disc_map()
        assert session.changed.wait_for(lambda: session.player.rate == expected, SECONDS)
    for several in (Plane.X_H, Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("III")))):
        session.state.plane = several
        assert session.player.rate == 0.0
        # A cached result is available at once.
        session.state.plane = Plane.X_PX
        assert session.player.rate == expected
