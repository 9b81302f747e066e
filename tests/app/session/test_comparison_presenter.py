"""A second view is compared with the view of the controls: its map is requested, drawn, counted and removed."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app.session.comparison_presenter import ComparisonPresenter
from app.state.view import View
from app.state.view_state import ViewState
from engine import CASES, EscapeMap, Fate, MapSpec, Plane, System, compute_map
from engine.jobs.manager import Jobs
from engine.slices.parameter_family import find_members
from engine.slices.slice_text import read_slice
from engine.systems.system import TYPED
from plots.pictures.image_columns import map_columns
from tests.app.map_actions import make_maps
from tests.app.session.session_lock import context_of
from tests.waiting import SECONDS

SPEC = MapSpec(CASES["I"], Plane.X_PX, 0.2, (56, 56), window=(-0.6, 0.6, -0.6, 0.6), t_max=100.0)
OTHER = View(System("I"), Plane.X_PX, 0.3)


class Session:
    """The parts of a session that a comparison needs."""

    def __init__(self, jobs: Jobs) -> None:
        self.changed = threading.Condition()
        self.said, self.refused = [""], [""]
        self.state = ViewState(system=System("I"), energy=0.2, t_max=100.0)
        self.maps = make_maps(self.state)
        self.context = context_of(self.state, jobs, self.changed)
        self.presenter = ComparisonPresenter(self.context, self.maps, self.said.append, self.refused.append)

    def show(self, frame: EscapeMap) -> None:
        self.maps.show(frame, map_columns(frame))
        self.context.results.frame = frame

    def wait_for(self, text: str) -> None:
        with self.changed:
            assert self.changed.wait_for(lambda: text in self.said[-1], SECONDS), self.said

    def wait_for_refusal(self, text: str) -> None:
        with self.changed:
            assert self.changed.wait_for(lambda: text in self.refused[-1], SECONDS), self.refused


@pytest.fixture(scope="module")
def frame() -> EscapeMap:
    return compute_map(SPEC)


@pytest.fixture(scope="module")
def jobs() -> Jobs:
    return Jobs()


@pytest.fixture
def session(jobs: Jobs) -> Iterator[Session]:
    made = Session(jobs)
    yield made
    made.context.jobs.close()


def test_the_share_of_other_outcomes_is_that_of_two_maps(session: Session, frame: EscapeMap) -> None:
    session.state.compared = OTHER
    session.show(frame)
    session.wait_for("starts have different outcomes")
    other = compute_map(replace(SPEC, energy=0.3))
    both = (frame.fate >= Fate.BOUNDED) & (other.fate >= Fate.BOUNDED)
    differ = np.count_nonzero(both & (frame.fate != other.fate))
    assert f"h = 0.3: {differ} of" in session.said[-1].replace("\u202f", "").replace(" 1 ", " 1")
    np.testing.assert_array_equal(session.maps.compared.source.data["fate"][0], map_columns(other)["fate"][0])
    assert session.maps.source.data["difference"][0].shape == (56, 56)
    session.state.compared = None
    assert session.said[-1] == ""
    assert session.maps.source.data["difference"][0].size == session.maps.compared.source.data["fate"][0].size == 1


def test_a_view_of_other_axes_is_shown_but_not_compared(session: Session, frame: EscapeMap) -> None:
    session.state.compared = View(System("I"), Plane.X_Y, 0.2)
    session.show(frame)
    session.wait_for("pixels cannot be compared")
    assert session.maps.compared.source.data["fate"][0].shape == (56, 56)
    assert session.maps.source.data["difference"][0].size == 1


def test_a_view_of_a_refused_system_ends_the_comparison(session: Session) -> None:
    # The view is refused before there is a map with which it could be compared.
    session.state.compared = View(System(TYPED, "x² − y²"), Plane.X_PX, 0.2)
    session.wait_for_refusal("There is no well")
    assert session.state.compared is None


def test_potentials_along_a_parameter_of_a_typed_formula_are_found_within_limits(frame: EscapeMap) -> None:
    def limit(call: Callable[[], Any], cancel: threading.Event) -> Any:
        # Only the search along the parameter takes too long.
        if call.func is find_members:  # type: ignore[attr-defined]
            raise ValueError("it takes too long.")
        return call()

    session, system = Session(Jobs(run_limited=limit)), System(TYPED, "½(x² + y²) − a x²y + y³/3")
    session.state.compared = View(system, read_slice("x,a=0.5:1.5", "", system), 0.1)
    session.show(frame)
    session.wait_for("There is no other view to compare with: it takes too long.")
    session.context.jobs.close()


def test_a_view_that_has_no_map_is_refused_in_a_sentence(session: Session, frame: EscapeMap) -> None:
    session.state.compared = View(System("I"), Plane.X_PX, 1000.0)
    session.show(frame)
    session.wait_for("There is no other view to compare with: ")
