"""The view that the browser gets follows the state of the page, and systems that need no compilation are requested with it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from app.job_clients.shown_results import ShownResults
from app.state.system_review import review_for_page
from app.state.view_state import ViewState
from app.views.panels.engine_component import BrowserEngine, describe_view
from engine import Coordinate, Fate, MapSpec, ParameterAxis, Plane, Slice, System, Window, compute_map, read_section
from engine.jobs.job import Job
from engine.jobs.subscription import Subscription
from engine.systems.system import TYPED
from plots.browser.browser_system import system_key
from plots.pictures.palette import PALETTES
from tests.app.browser_messages import send
from tests.app.map_actions import make_browser_engine


@dataclass
class Requests:
    """Keeps the jobs that are requested, and computes none."""

    jobs: list[Job[Any]] = field(default_factory=list)

    def request(self, job: Job[Any], on_result: Any, on_error: Any) -> Subscription:
        self.jobs.append(job)
        return Subscription(lambda subscription: None, on_result, on_error)

    @property
    def systems(self) -> list[str]:
        """The keys of the requested systems."""
        return [system_key(potential, section) for potential, _, _, section in (job.arguments for job in self.jobs)]


def make_engine(state: ViewState) -> tuple[BrowserEngine, ShownResults, Requests]:
    """Return the engine of a page, with its results and its requests."""
    results, requests = ShownResults(), Requests()
    at_once = lambda function: function  # noqa: E731
    engine = BrowserEngine(state, results, requests, at_once, lambda window: None, lambda: None, lambda pixels: None)
    return engine, results, requests


def test_a_system_that_is_compiled_in_advance_is_requested_with_the_view_and_once() -> None:
    state = ViewState(system=System("III"), energy=0.45)
    engine, results, requests = make_engine(state)
    engine.show_view()
    assert requests.systems == [engine.view["system"]]
    results.frame = compute_map(MapSpec(state.potential, Plane.X_PX, 0.45, (4, 4), t_max=10.0))
    state.energy = 0.5
    assert len(requests.jobs) == 1
    state.show_system(review_for_page(System("C4")))
    assert requests.systems[1:] == [engine.view["system"]]


def test_another_system_is_requested_with_the_first_frame_of_its_map() -> None:
    state = ViewState(system=System("I"))
    engine, results, requests = make_engine(state)
    state.show_system(review_for_page(System(TYPED, "½(x² + y²) − x²y² − x³/4")))
    assert requests.jobs == []
    results.frame = compute_map(MapSpec(state.potential, Plane.X_PX, state.energy, (4, 4), t_max=10.0))
    assert requests.systems == [engine.view["system"]]
    # A map of another section does not compile the step of this one.
    state.section = read_section("y = 0 down")
    assert len(requests.jobs) == 1


def test_a_view_follows_the_state() -> None:
    state = ViewState(system=System("III"), energy=0.45, plane=Plane.X_Y, palette="safe")
    view = describe_view(state)
    assert (view["plane"], view["window"]) == ("x_y", None)
    assert view["colours"][0] == "#009e73"
    assert view["labels"] == ["exit 1", "exit 2", "exit 3", "exit 4"]
    assert view["coding"]["ends"] == [0, 1, 2, 3]
    assert view["energies"] == [state.energies.low, state.energies.high]


def test_shares_of_starts_that_stay_have_the_greys_of_the_maps() -> None:
    state = ViewState(system=System("I"), palette="safe")
    outcomes = PALETTES["safe"].outcomes
    inside = [(fate, outcomes[fate].colour) for fate in (Fate.BOUNDED, Fate.NOT_COMPUTED, Fate.FAILED)]
    assert describe_view(state)["stack"] == [(1, "#009e73"), (2, "#d55e00"), *inside]


def test_a_view_has_its_chosen_window() -> None:
    view = describe_view(ViewState(window=Window(-0.1, 0.2, -0.3, 0.4)))
    assert view["window"] == {"xLow": -0.1, "xHigh": 0.2, "ordinateLow": -0.3, "ordinateHigh": 0.4}


def test_slices_along_a_parameter_have_no_browser_view() -> None:
    view = describe_view(
        ViewState(system=System("I"), plane=Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))))
    )
    assert view["slice"] is None
    assert view["plane"] == "x,epsilon=0.5:2.0"


def test_the_browser_learns_the_section_and_where_its_points_are_drawn() -> None:
    state = ViewState(system=System("I"), energy=0.19)
    first = describe_view(state)
    assert first["slice"]["sectionColumns"] == [0, 2]
    state.show_section(read_section("x = 0.05"), with_slice=True)
    view = describe_view(state)
    assert view["system"] != first["system"]
    assert view["slice"]["sectionColumns"] == [1, 3]
    assert view["coding"]["crossingWords"] == ["upward crossing of x = 0.05", "upward crossings of x = 0.05"]
    # Mirror images of orbits cross x = −0.05.
    assert view["slice"]["mirrored"] is None
    state.show_slice(Plane.X_Y)
    assert describe_view(state)["slice"]["sectionColumns"] is None


def test_a_film_is_an_animation_that_ends_as_any_other() -> None:
    engine = make_browser_engine(ViewState(system=System("I"), energy=0.19))
    engine.film()
    assert (engine.playing, engine.command["name"]) == (True, "film")
    engine.film()
    assert engine.command["name"] == "stop"
    send(engine, {"playing": False})
    assert not engine.playing


def test_the_pixels_of_the_screen_are_passed_on_and_other_values_are_ignored() -> None:
    pixels: list[int] = []
    engine = make_browser_engine(on_pixels=pixels.append)
    for value in (756, "900", None, 0):
        send(engine, {"pixels": value})
    assert pixels == [756, 0]
