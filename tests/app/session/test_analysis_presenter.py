"""Analyses of a map are requested, and their results shown."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app.session.analysis_presenter import AnalysisPresenter
from app.state.view import Analysis
from app.state.view_state import ViewState
from engine import CASES, EscapeMap, MapSpec, Plane, System, Trust, Window, compute_map
from engine.jobs.manager import Jobs
from plots.layers.layer import Analyses
from plots.layers.table import LAYERS
from plots.links.map_view import default_settings
from plots.pictures.palette import CLEAR
from tests.app.map_actions import make_maps
from tests.app.session.session_lock import context_of
from tests.waiting import SECONDS


class Session:
    """The parts of a session that analyses need."""

    def __init__(self, jobs: Jobs, **chosen: Any) -> None:
        self.changed = threading.Condition()
        self.state, self.jobs = ViewState(system=System("II"), energy=0.25, resolution=112, t_max=1e3, **chosen), jobs
        self.maps = make_maps(self.state)
        self.context = context_of(self.state, self.jobs, self.changed, self.open_view)
        self.presenter = AnalysisPresenter(self.context, self.maps)

    def open_view(self, system: System, values: dict[str, Any]) -> None:
        self.opened = system, values

    @property
    def analyses(self) -> Analyses:
        found: Analyses = self.context.results.analyses
        return found

    def show(self, frame: EscapeMap) -> None:
        self.context.results.frame = frame

    def wait_for(self, true: Callable[[], bool]) -> None:
        with self.changed:
            assert self.changed.wait_for(true, SECONDS), (
                self.context.notice.layout().object,
                self.presenter.notes.object,
                self.presenter.measures.text.object,
            )


@pytest.fixture(scope="module")
def frame() -> EscapeMap:
    return compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (112, 112), t_max=1e3))


def unfinished(frame: EscapeMap, energy: float) -> EscapeMap:
    """Return a frame of a map of another energy."""
    return replace(frame, spec=replace(frame.spec, energy=energy), complete=False)


@pytest.fixture
def open_sessions() -> Iterator[list[Session]]:
    sessions: list[Session] = []
    yield sessions
    for session in sessions:
        session.context.jobs.close()


@pytest.fixture(scope="module")
def jobs() -> Jobs:
    """Return jobs whose results all sessions share."""
    return Jobs()


@pytest.fixture
def begin(open_sessions: list[Session], jobs: Jobs) -> Callable[..., Session]:
    def begin_session(**chosen: Any) -> Session:
        open_sessions.append(Session(jobs, **chosen))
        return open_sessions[-1]

    return begin_session


def test_doubtful_pixels_are_marked_until_the_layer_is_off_or_the_map_changes(
    begin: Callable[..., Session], frame: EscapeMap
) -> None:
    session = begin(layers=frozenset({"trust"}))
    session.show(frame)
    session.wait_for(lambda: "trust" in session.analyses)
    over = LAYERS["trust"].over
    assert over is not None
    assert over.pixel_colours is not None
    marks = np.array(over.pixel_colours)[session.maps.source.data["trust"][0]]
    np.testing.assert_array_equal(marks != CLEAR, session.analyses["trust"].trust == Trust.DOUBTFUL)
    assert "doubtful" in session.presenter.notes.object
    session.show(unfinished(frame, 0.26))
    assert session.analyses == {}
    session.show(frame)
    session.wait_for(lambda: "trust" in session.analyses)
    session.state.layers = frozenset()
    shown = session.maps.source.data["trust"][0].size
    assert (session.analyses, shown, session.presenter.notes.object) == ({}, 1, "")


def test_all_images_of_manifolds_or_one_are_drawn_over_their_section(begin: Callable[..., Session], frame: EscapeMap) -> None:
    session = begin(layers=frozenset({"manifolds"}), settings={**default_settings(), "images": 1})
    session.show(compute_map(MapSpec(CASES["II"], Plane.X_Y, 0.25, (16, 16), t_max=100.0)))
    assert session.jobs.in_flight == 0
    assert "(x, y) is not such a slice" in session.presenter.notes.object
    session.show(frame)
    session.wait_for(lambda: "manifolds" in session.analyses)
    numbers = []
    for image in (1, 2, 0):
        session.state.settings = {**session.state.settings, "images": image}
        shown = session.analyses["manifolds"].arcs
        assert {arc.image for arc in shown} == ({image} if image else {1, 2, 3})
        numbers.append(len(shown))
        assert sum(int(np.isnan(xs).sum()) - 1 for xs in session.maps.overlays.curves["manifolds"].data["xs"]) == len(shown)
    assert 0 < numbers[0] < numbers[1] < numbers[2]


def test_a_picture_says_that_its_layer_is_being_computed_until_it_is(begin: Callable[..., Session]) -> None:
    session = begin(layers=frozenset({"origins", "trust"}))
    # No other test computes layers of this map, so no result is cached.
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (48, 48), t_max=1e3))
    session.maps.show(frame, {**session.maps.source.data})

    def notes() -> list[str]:
        return [session.maps.figures[name].elements[0].html.partition("role='status'>")[2].partition("<")[0] for name in shown]

    shown = ("origins", "basins", "times")
    # No result can arrive while the test holds the lock.
    with session.changed:
        session.show(frame)
        # Only the two large pictures have room for the names of layers.
        assert notes() == ["…", "trust …", ""]
    session.wait_for(lambda: {*session.analyses} == {"origins", "trust"})
    assert notes() == ["", "", ""]


def test_a_result_of_other_settings_is_not_shown(begin: Callable[..., Session], frame: EscapeMap) -> None:
    session = begin(layers=frozenset({"descriptor"}))
    session.maps.show(frame, {**session.maps.source.data})
    session.show(frame)
    session.wait_for(lambda: "descriptor" in session.analyses)
    assert session.maps.source.data["descriptor_value"][0].shape == frame.fate.shape
    with session.changed:
        session.state.settings = {**session.state.settings, "descriptor_power": 1.0}
        assert "descriptor" not in session.analyses
        assert session.maps.source.data["descriptor_value"][0].size == 1
    session.wait_for(lambda: "descriptor" in session.analyses)
    assert session.analyses["descriptor"].power == 1.0


def test_basins_are_measured_and_laws_are_fitted_in_the_box(begin: Callable[..., Session], frame: EscapeMap) -> None:
    session = begin(analysis=Analysis.MEASURES)
    session.show(frame)
    measures = session.presenter.measures
    session.wait_for(lambda: all(name in measures.text.object for name in ("Basin entropy", "Wada", "Decay law", "Flux")))
    lines = measures.survival.lines
    whole = len(lines.data["xs"][0])
    assert whole > 10
    session.state.box = Window(-0.2, 0.3, -0.2, 0.2)
    session.wait_for(lambda: len(lines.data["xs"][0]) != whole)


def test_another_map_cancels_a_slow_measure(begin: Callable[..., Session], frame: EscapeMap) -> None:
    session = begin(analysis=Analysis.MEASURES)
    session.wait_for(lambda: session.jobs.in_flight == 0)
    session.presenter.measures.buttons["chaotic_share"].clicks += 1
    assert session.jobs.in_flight == 1
    session.show(unfinished(frame, 0.3))
    assert session.jobs.in_flight == 0
