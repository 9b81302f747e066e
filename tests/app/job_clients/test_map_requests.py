"""The controller submits, drops what is stale, and says what went wrong; no server is needed to see that."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from app.job_clients.map_requests import MapRequests
from app.state.view_state import ViewState
from engine import CASES, EscapeMap, Jobs, MapSpec, Plane, Subscription, compute_map
from engine.jobs.requests import WarmupAnswer


class Recorder:
    """A listener that writes down what it is told."""

    def __init__(self) -> None:
        self.told: list[tuple[str, Any]] = []
        self.changed = threading.Condition()

    def tell(self, what: str, value: Any = None) -> None:
        with self.changed:
            self.told.append((what, value))
            self.changed.notify_all()

    def names(self) -> list[str]:
        return [what for what, _ in self.told]

    def wait_for(self, true: Callable[[], bool], seconds: float = 30.0) -> None:
        with self.changed:
            assert self.changed.wait_for(true, seconds), self.names()

    def map_requested(self, *, compiling: bool = False) -> None:
        self.tell("map requested")

    def map_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        self.tell("map arrived", frame)

    def map_stopped(self) -> None:
        self.tell("map stopped")

    def map_failed(self, sentence: str) -> None:
        self.tell("map failed", sentence)

    def preview_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        self.tell("preview arrived", frame)

    def last_frame(self) -> EscapeMap | None:
        frames = [value for what, value in self.told if what == "map arrived"]
        return frames[-1] if frames else None

    def complete(self) -> bool:
        frame = self.last_frame()
        return frame is not None and frame.complete


@pytest.fixture
def session() -> Iterator[tuple[ViewState, MapRequests, Recorder, Jobs]]:
    state, recorder, jobs = ViewState(case="I", energy=0.3, resolution=113, t_max=1e2), Recorder(), Jobs()
    controller = MapRequests(state, jobs, recorder, lambda function: function)
    yield state, controller, recorder, jobs
    controller.close()


Session = tuple[ViewState, MapRequests, Recorder, Jobs]


def test_a_map_comes_in_frames_and_ends_complete(session: Session) -> None:
    _, controller, recorder, _ = session
    controller.request_map()
    recorder.wait_for(recorder.complete)
    assert recorder.names()[0] == "map requested"
    assert recorder.names().count("map arrived") >= 2


def test_no_frame_of_an_old_energy_follows_one_of_the_new(session: Session) -> None:
    state, _, recorder, _ = session
    state.t_max = 1e4
    for energy in (0.31, 0.32, 0.33):
        state.energy = energy
    recorder.wait_for(lambda: recorder.complete() and recorder.last_frame().spec.energy == 0.33)  # type: ignore[union-attr]
    seen = [value.spec.energy for what, value in recorder.told if what == "map arrived"]
    assert seen == sorted(seen)


class Latest:
    """A session that comes to what it is told later, and knows the latest only."""

    def __init__(self) -> None:
        self.told: dict[Callable[..., None], tuple[Any, ...]] = {}

    def locked(self, receive: Callable[..., None]) -> Callable[..., None]:
        return lambda *what: self.told.update({receive: what})

    def come_to_it(self) -> None:
        while self.told:
            receive, what = self.told.popitem()
            receive(*what)


class Asked:
    """Requests that are answered by the test."""

    def __init__(self) -> None:
        self.listeners: list[Callable[[Any], None]] = []

    def request_map(self, spec: MapSpec, on_frame: Callable[[Any], None], on_error: Callable[[Exception], None]) -> Subscription:
        return self.request(spec, on_frame, on_error)

    def request(self, spec: Any, on_result: Callable[[Any], None], on_error: Callable[[Exception], None]) -> Subscription:
        self.listeners.append(on_result)
        return Subscription(lambda ticket: None, on_result, on_error)


def test_what_comes_too_late_does_not_take_the_place_of_what_is_wanted() -> None:
    state, recorder, asked, session = ViewState(case="I"), Recorder(), Asked(), Latest()
    controller = MapRequests(state, asked, recorder, session.locked)
    specs = [MapSpec(CASES["I"], Plane.X_PX, energy, (8, 8), t_max=10.0) for energy in (0.3, 0.31)]
    for spec in specs:
        controller.request_map()
        asked.listeners[-1](WarmupAnswer(spec))
        session.come_to_it()
    _, late, _, wanted = asked.listeners
    wanted(compute_map(specs[1]))
    late(compute_map(specs[0]))
    session.come_to_it()
    frame = recorder.last_frame()
    assert frame is not None
    assert frame.spec == specs[1]


def test_cancelling_stops_the_job_and_going_on_finishes_it(session: Session) -> None:
    state, controller, recorder, jobs = session
    state.param.update(case="III", energy=0.26, t_max=1e5)
    recorder.wait_for(lambda: recorder.last_frame() is not None)
    controller.stop_map()
    assert jobs.in_flight == 0
    frames = recorder.names().count("map arrived")
    time.sleep(0.5)
    assert recorder.names().count("map arrived") == frames
    assert recorder.names()[-1] == "map stopped"


def test_a_map_that_is_whole_is_not_stopped(session: Session) -> None:
    _, controller, recorder, _ = session
    controller.request_map()
    recorder.wait_for(recorder.complete)
    controller.stop_map()
    assert "map stopped" not in recorder.names()


def test_an_energy_without_exits_is_refused_in_words(session: Session) -> None:
    state, _, recorder, _ = session
    state.energy = 50.0
    recorder.wait_for(lambda: "map failed" in recorder.names())
    sentence = next(value for what, value in recorder.told if what == "map failed")
    assert "energy=50.0" in sentence


def previews(recorder: Recorder) -> list[EscapeMap]:
    return [value for what, value in recorder.told if what == "preview arrived"]


def test_a_quick_look_ends_at_the_energy_looked_at_last(session: Session) -> None:
    _, controller, recorder, jobs = session
    for energy in (0.31, 0.32, 0.33, 0.34):
        controller.request_preview(energy)
    recorder.wait_for(lambda: bool(previews(recorder)) and previews(recorder)[-1].spec.energy == 0.34)
    assert jobs.in_flight == 0
    assert not controller.previews.under_way


def test_a_quick_look_stops_the_map_on_its_way(session: Session) -> None:
    state, controller, recorder, _ = session
    state.param.update(case="III", energy=0.26, t_max=1e5)
    recorder.wait_for(lambda: recorder.last_frame() is not None)
    controller.request_preview(0.5)
    frames = recorder.names().count("map arrived")
    recorder.wait_for(lambda: bool(previews(recorder)))
    time.sleep(0.3)
    assert recorder.names().count("map arrived") == frames


def test_after_a_map_is_asked_for_no_quick_look_is_painted(session: Session) -> None:
    state, controller, recorder, _ = session
    for energy in (0.31, 0.32, 0.33):
        controller.request_preview(energy)
    state.energy = 0.35
    recorder.wait_for(recorder.complete)
    names = recorder.names()
    assert "preview arrived" not in names[names.index("map requested") :]


def test_a_quick_look_at_nothing_leaves_the_picture(session: Session) -> None:
    _, controller, recorder, _ = session
    controller.request_preview(50.0)
    end = time.monotonic() + 30.0
    while controller.previews.under_way and time.monotonic() < end:
        time.sleep(0.01)
    assert not controller.previews.under_way
    assert recorder.names() == []


def test_a_session_that_ends_leaves_no_job_behind(session: Session) -> None:
    state, controller, recorder, jobs = session
    state.param.update(case="III", energy=0.26, t_max=1e6)
    recorder.wait_for(lambda: recorder.last_frame() is not None)
    controller.close()
    assert jobs.in_flight == 0
