"""Maps are requested from jobs, and late results and errors are handled, without a server."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest

from app.job_clients.map_requests import MapRequests
from app.state.system_review import review_for_page
from app.state.view_state import ViewState
from engine import CASES, EscapeMap, MapSpec, Plane, System, Window, compute_map
from engine.jobs.client import JobClient
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.jobs.subscription import Subscription
from engine.maps.warmup import prepare_for_maps
from engine.slices.slice_text import read_slice
from engine.systems.system import TYPED
from tests.waiting import SECONDS


class Recorder:
    """A listener that records its calls."""

    def __init__(self) -> None:
        self.calls: list[tuple[str, Any]] = []
        self.changed = threading.Condition()

    def record(self, what: str, value: Any = None) -> None:
        with self.changed:
            self.calls.append((what, value))
            self.changed.notify_all()

    def names(self) -> list[str]:
        return [what for what, _ in self.calls]

    def wait_for(self, true: Callable[[], bool]) -> None:
        with self.changed:
            assert self.changed.wait_for(true, SECONDS), self.names()

    def map_requested(self, *, compiling: bool = False) -> None:
        self.record("map requested")

    def map_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        self.record("map arrived", frame)

    def map_sharpened(self, sharper_map: EscapeMap, columns: dict[str, list[Any]]) -> None:
        self.record("map sharpened", (sharper_map, columns))

    def map_stopped(self) -> None:
        self.record("map stopped")

    def map_failed(self, sentence: str) -> None:
        self.record("map failed", sentence)

    def last_frame(self) -> EscapeMap | None:
        frames = [value for what, value in self.calls if what == "map arrived"]
        return frames[-1] if frames else None

    def complete(self) -> bool:
        frame = self.last_frame()
        return frame is not None and frame.complete


@pytest.fixture
def session() -> Iterator[tuple[ViewState, MapRequests, Recorder, Jobs]]:
    state, recorder, jobs = ViewState(system=System("I"), energy=0.3, resolution=112, t_max=1e2), Recorder(), Jobs()
    client = JobClient(jobs)
    requests = MapRequests(
        state,
        client,
        recorder,
        lambda function: function,
        prepare=lambda spec: recorder.record("prepared", threading.current_thread()),
    )
    yield state, requests, recorder, jobs
    client.close()


Session = tuple[ViewState, MapRequests, Recorder, Jobs]


def test_what_the_listener_needs_is_computed_before_each_frame_on_the_thread_of_the_job(session: Session) -> None:
    _, requests, recorder, _ = session
    requests.request_map()
    recorder.wait_for(recorder.complete)
    names = [name for name in recorder.names() if name != "map requested"]
    assert names == ["prepared", "map arrived"] * (len(names) // 2)
    assert all(value is not threading.current_thread() for name, value in recorder.calls if name == "prepared")


def test_a_map_arrives_in_frames_and_ends_complete(session: Session) -> None:
    _, requests, recorder, _ = session
    requests.request_map()
    recorder.wait_for(recorder.complete)
    assert recorder.names()[0] == "map requested"
    assert recorder.names().count("map arrived") >= 2
    requests.stop_map()
    assert "map stopped" not in recorder.names()


def test_no_frame_of_the_old_energy_follows_a_frame_of_the_new(session: Session) -> None:
    state, _, recorder, _ = session
    state.t_max = 1e4
    for energy in (0.31, 0.32, 0.33):
        state.energy = energy
    recorder.wait_for(lambda: recorder.complete() and recorder.last_frame().spec.energy == 0.33)  # type: ignore[union-attr]
    seen = [value.spec.energy for what, value in recorder.calls if what == "map arrived"]
    assert seen == sorted(seen)


class LatestCalls:
    """Collects calls, and runs each callback later with the latest of its arguments."""

    def __init__(self) -> None:
        self.pending: dict[Callable[..., None], tuple[Any, ...]] = {}

    def locked(self, callback: Callable[..., None]) -> Callable[..., None]:
        return lambda *arguments: self.pending.update({callback: arguments})

    def run(self) -> None:
        while self.pending:
            callback, arguments = self.pending.popitem()
            callback(*arguments)


class ManualJobs:
    """Accepts requests; the test delivers their results."""

    def __init__(self) -> None:
        self.jobs: list[Job[Any]] = []
        self.listeners: list[Callable[[Any], None]] = []

    def request(self, job: Any, on_result: Callable[[Any], None], on_error: Callable[[Exception], None]) -> Subscription:
        self.jobs.append(job)
        self.listeners.append(on_result)
        return Subscription(lambda subscription: None, on_result, on_error)


@pytest.fixture
def manual() -> tuple[MapRequests, Recorder, ManualJobs, LatestCalls]:
    prepare_for_maps(CASES["I"])
    recorder, jobs, session = Recorder(), ManualJobs(), LatestCalls()
    return MapRequests(ViewState(system=System("I")), jobs, recorder, session.locked), recorder, jobs, session


def test_a_late_frame_does_not_replace_the_current_map(manual: tuple[MapRequests, Recorder, ManualJobs, LatestCalls]) -> None:
    requests, recorder, jobs, session = manual
    specs = [MapSpec(CASES["I"], Plane.X_PX, energy, (8, 8), t_max=10.0) for energy in (0.3, 0.31)]
    for _ in specs:
        requests.request_map()
    late, wanted = jobs.listeners
    wanted(compute_map(specs[1]))
    late(compute_map(specs[0]))
    session.run()
    frame = recorder.last_frame()
    assert frame is not None
    assert frame.spec == specs[1]


def test_cancelling_stops_the_job(session: Session) -> None:
    state, requests, recorder, jobs = session
    state.param.update(system=System("III"), energy=0.26, t_max=1e5)
    recorder.wait_for(lambda: recorder.last_frame() is not None)
    requests.stop_map()
    assert jobs.in_flight == 0
    assert recorder.names()[-1] == "map stopped"


def test_a_frame_after_a_stop_is_dropped(manual: tuple[MapRequests, Recorder, ManualJobs, LatestCalls]) -> None:
    requests, recorder, jobs, session = manual
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.3, (8, 8), t_max=10.0)
    requests.request_map()
    requests.stop_map()
    jobs.listeners[0](compute_map(spec))
    session.run()
    assert recorder.names() == ["map requested", "map stopped"]


def test_a_crowded_server_shows_the_first_frame_of_each_request_alone_before_the_last() -> None:
    prepare_for_maps(CASES["I"])
    recorder, jobs, session = Recorder(), ManualJobs(), LatestCalls()
    requests = MapRequests(ViewState(system=System("I")), jobs, recorder, session.locked, is_crowded=lambda: True)
    unfinished = replace(compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (8, 8), t_max=10.0)), complete=False)
    for _ in range(2):
        requests.request_map()
        for frame in (unfinished, unfinished, replace(unfinished, complete=True)):
            jobs.listeners[-1](frame)
            session.run()
    assert recorder.names() == ["map requested", "map arrived", "map arrived"] * 2


def test_a_request_that_is_replaced_while_its_integrator_is_compiled_starts_no_map() -> None:
    state, jobs, session = ViewState(), ManualJobs(), LatestCalls()
    # No other test compiles the integrator of this formula.
    state.show_system(review_for_page(System(TYPED, "½(x² + y²) + x²y − y³/3 + 0.0013x^6")))
    requests = MapRequests(state, jobs, Recorder(), session.locked)
    requests.request_map()
    jobs.listeners[0](None)
    requests.request_map()
    session.run()
    assert len(jobs.listeners) == 2
    jobs.listeners[1](None)
    session.run()
    assert len(jobs.listeners) == 3


def test_potentials_along_a_parameter_of_a_typed_formula_are_found_within_limits_first() -> None:
    state, recorder, jobs, session = ViewState(), Recorder(), ManualJobs(), LatestCalls()
    MapRequests(state, jobs, recorder, session.locked)
    reviewed = review_for_page(System(TYPED, "½(x² + y²) − a x²y + y³/3"))
    prepare_for_maps(reviewed.potential)
    state.show_system(reviewed)
    state.plane = read_slice("x,a=0.5:1.5", "", state.system)
    assert jobs.jobs[-1].queue is Queue.LIMITED
    requested, told = len(jobs.jobs), recorder.names()
    jobs.listeners[-1](None)
    session.run()
    assert [job.queue for job in jobs.jobs[requested:]] == [Queue.FIRST_FRAME]
    assert recorder.names() == told


def test_an_invalid_energy_gives_a_message(session: Session) -> None:
    state, _, recorder, _ = session
    state.energy = 1000.0
    recorder.wait_for(lambda: "map failed" in recorder.names())
    sentence = next(value for what, value in recorder.calls if what == "map failed")
    assert sentence.startswith("h = 1000: ")


@pytest.mark.parametrize("window", [None, Window(-0.2, 0.2, -0.2, 0.2)])
@pytest.mark.parametrize("energy", [-1.0, 1e-320, 1e9])
def test_an_energy_without_an_interior_is_refused_in_every_window(session: Session, energy: float, window: Window | None) -> None:
    state, _, recorder, _ = session
    state.param.update(energy=energy, window=window)
    recorder.wait_for(lambda: "map failed" in recorder.names())
    assert recorder.last_frame() is None


def sharper_maps(recorder: Recorder) -> list[EscapeMap]:
    return [value[0] for name, value in recorder.calls if name == "map sharpened"]


def test_a_complete_map_gets_the_pixels_of_its_picture_step_by_step(session: Session) -> None:
    state, requests, recorder, _ = session
    requests.sharpen(200)
    requests.request_map()
    recorder.wait_for(recorder.complete)
    assert sharper_maps(recorder) == []
    requests.sharpen(200)
    recorder.wait_for(lambda: len(sharper_maps(recorder)) == 1)
    [sharper] = sharper_maps(recorder)
    assert sharper.complete
    assert sharper.spec == replace(state.map_spec(), resolution=(224, 224))
    assert next(value[1] for name, value in recorder.calls if name == "map sharpened")["fate"][0].shape == (224, 224)
    # The map of the view stays that of the chosen resolution.
    assert recorder.last_frame().spec.resolution == (112, 112)  # type: ignore[union-attr]


def complete_frame(state: ViewState) -> EscapeMap:
    frame = compute_map(state.map_spec())
    assert frame.complete
    return frame


def test_more_pixels_are_computed_after_everything_else_and_not_for_an_old_view_or_small_picture() -> None:
    state, jobs = ViewState(system=System("I"), energy=0.3, resolution=112, t_max=1e2), ManualJobs()
    requests = MapRequests(state, jobs, Recorder(), lambda function: function)
    requests.request_map()
    jobs.listeners[-1](complete_frame(state))
    requests.sharpen(112)
    requests.sharpen(0)
    assert len(jobs.jobs) == 1
    requests.sharpen(113)
    assert [job.queue for job in jobs.jobs[1:]] == [Queue.SPARE]
    state.energy = 0.31
    requests.sharpen(113)
    assert [job.queue for job in jobs.jobs[2:]] == [Queue.FIRST_FRAME]


def test_a_crowded_server_computes_no_more_pixels() -> None:
    state, jobs = ViewState(system=System("I"), energy=0.3, resolution=112, t_max=1e2), ManualJobs()
    requests = MapRequests(state, jobs, Recorder(), lambda function: function, lambda: True)
    requests.request_map()
    jobs.listeners[-1](complete_frame(state))
    requests.sharpen(900)
    assert len(jobs.jobs) == 1


def test_the_map_of_the_view_comes_back_with_a_layer_of_pixels(session: Session) -> None:
    state, requests, recorder, _ = session
    requests.request_map()
    recorder.wait_for(recorder.complete)
    requests.sharpen(200)
    recorder.wait_for(lambda: len(sharper_maps(recorder)) == 1)
    state.layers = frozenset({"manifolds"})
    assert recorder.names()[-1] == "map sharpened"
    state.layers = frozenset({"manifolds", "judge"})
    assert recorder.calls[-1] == ("map arrived", recorder.last_frame())
    assert recorder.complete()
    requests.sharpen(200)
    assert len(sharper_maps(recorder)) == 1
    # Without the layer, the pixels come back.
    state.layers = frozenset()
    requests.sharpen(200)
    recorder.wait_for(lambda: len(sharper_maps(recorder)) == 2)
