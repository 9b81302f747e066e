"""Potentials are chosen or typed, reviewed, and refused with messages."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from html import escape

import pytest

from app.session.context import History
from app.session.potential_presenter import PotentialPresenter
from app.state.system_review import review_for_page
from app.state.view_state import ViewState
from app.views.analysis.potential_panel import OUTDATED
from engine import CASES, MapSpec, System
from engine.jobs.manager import Jobs
from engine.maps.warmup import prepare_for_maps
from engine.systems.parameters import WELL_PARAMETERS
from engine.systems.system import TYPED
from tests.app.browser_messages import send
from tests.app.session.session_lock import context_of
from tests.waiting import SECONDS

# A potential with the integrator of case I.
WEAKER = "½(x² + y²) − 0.5xy²"
STRONGER = "½(x² + y²) − 2xy²"
# A potential with an integrator that no other test compiles.
NEW = "½(x² + y²) + x²y − y³/3 + 0.001x^6"
# The channels 1 and 3 merge at h = 0.5.
CHANNELS_THAT_MERGE = "½(x² + y²) − xy² − x⁴/8"
# Case I with its well at (1, 0).
WELL_ELSEWHERE = "((x−1)² + y²)/2 − (x−1)y²"
TOO_LONG = "½r² + " + "+".join(["xy²"] * 200)


class Session:
    """The parts of a session that the choice of a potential needs."""

    def __init__(self) -> None:
        self.changed = threading.Condition()
        self.state, self.history = ViewState(system=System("I"), energy=0.25, starts=((0.1, 0.1),)), History()
        self.context = context_of(self.state, Jobs(), self.changed)
        self.sketches: list[MapSpec | None] = []
        self.presenter = PotentialPresenter(self.context, self.history, self.sketches.append)
        self.panel = self.presenter.panel

    def type(self, text: str, *, enter: bool = True) -> None:
        send(self.panel.formula, {"value": text, "count": 1, "done": enter})

    def slide(self, name: str, number: float, *, done: bool = True) -> None:
        send(self.panel.sliders, {"name": name, "value": number, "count": 1, "done": done})

    def sliders(self) -> dict[str, dict[str, float]]:
        """Return the fields of each slider on the page, by the name of the parameter."""
        return {row["name"]: row for row in self.panel.sliders.rows}

    def wait_for(self, condition: Callable[[], bool]) -> None:
        with self.changed:
            assert self.changed.wait_for(condition, SECONDS), self.panel.message.object

    def wait_for_message(self, text: str) -> None:
        self.wait_for(lambda: text in self.panel.message.object)


@pytest.fixture
def session() -> Iterator[Session]:
    prepare_for_maps(CASES["I"])
    made = Session()
    yield made
    made.context.jobs.close()


def test_the_well_of_a_text_that_is_not_used_yet_is_drawn_until_the_text_is_that_of_the_view(session: Session) -> None:
    session.type(NEW, enter=False)
    session.wait_for(lambda: bool(session.sketches))
    [sketch] = session.sketches
    assert sketch is not None
    assert sketch.potential == System.from_formula(NEW).potential
    # The energy has the same place in the well: twice the escape energy.
    assert sketch.energy == pytest.approx(2.0 * sketch.potential.escape_energy, rel=1e-2)
    session.type("½(x² + y²) − xy²", enter=False)
    session.wait_for(lambda: session.sketches[-1] is None)


@pytest.mark.parametrize("text", ["-x^2 - y^2", "½(x² +"])
def test_the_well_of_a_text_is_not_drawn_beside_a_later_text_that_cannot_be_used(session: Session, text: str) -> None:
    session.type(NEW, enter=False)
    session.wait_for(lambda: bool(session.sketches))
    session.type(text, enter=False)
    session.wait_for(lambda: session.sketches[-1] is None)


def test_a_text_is_used_while_it_is_typed_unless_it_needs_another_integrator(session: Session) -> None:
    newer = {"value": WEAKER, "count": 2, "done": False}
    watcher = session.state.param.watch(lambda event: send(session.panel.formula, newer), "system")
    session.type(WEAKER, enter=False)
    session.wait_for(lambda: session.state.system.formula == WEAKER)
    assert "2 exits above h = 0.5" in session.panel.message.object
    # The text that was typed meanwhile stays.
    assert session.panel.formula.shown == {"value": WEAKER, "count": 2}
    session.state.param.unwatch(watcher)
    session.type(NEW, enter=False)
    session.wait_for_message("Press Enter")
    assert "The maps still show" in session.panel.message.object
    assert session.state.system.formula == WEAKER
    session.type(NEW)
    session.wait_for(lambda: session.state.system.formula == NEW)


def test_properties_of_the_last_formula_are_grey_while_the_next_is_reviewed(session: Session) -> None:
    panes = session.panel.typeset, session.panel.facts
    session.panel.wait()
    assert all(OUTDATED in pane.css_classes for pane in panes)
    session.panel.show(session.panel.used)
    assert not any(OUTDATED in pane.css_classes for pane in panes)


def test_all_texts_are_used_in_turn_and_are_one_entry_of_the_history_until_enter(session: Session) -> None:
    used, entries = list[str](), list[int]()
    session.state.param.watch(lambda event: (used.append(event.new.formula), entries.append(session.history.record())), "system")
    session.type(STRONGER, enter=False)
    # Type further during the review.
    session.type(WEAKER, enter=False)
    session.wait_for(lambda: session.state.system.formula == WEAKER)
    session.type(WEAKER)
    session.type(STRONGER)
    session.wait_for(lambda: session.state.system.formula == STRONGER)
    assert (used, entries) == ([STRONGER, WEAKER, STRONGER], [1, 1, 2])


@pytest.mark.parametrize(
    ("energy", "text", "expected", "starts"),
    [
        # The energy keeps its ratio to the escape energy. The starts would be other orbits, so they are removed.
        (0.25, WEAKER, 1.0, 0),
        # The potential is the same, so energy and starts stay.
        (0.25, "½(x² + y²) − x y y", 0.25, 1),
        # The ratio leads beyond the highest energy, so the system has its initial energy.
        (5.0, CHANNELS_THAT_MERGE, None, 0),
    ],
)
def test_a_typed_potential_keeps_the_ratio_to_the_escape_energy(
    session: Session, energy: float, text: str, expected: float | None, starts: int
) -> None:
    session.state.energy = energy
    session.type(text)
    session.wait_for(lambda: session.state.system.case == TYPED)
    assert session.state.energy == (expected or session.state.energies.first)
    assert len(session.state.starts) == starts
    assert session.panel.known.value == TYPED


@pytest.mark.parametrize(
    ("text", "reason", "points"),
    [
        ("x² + <b>", "character 6", ""),
        ("", "ends where", ""),
        (TOO_LONG, f"the text has {len(TOO_LONG)} characters; at most 500 characters", ""),
        ("x²y²", "valley", "valley"),
        (WELL_ELSEWHERE, "no well at the origin", "<td>minimum</td><td>(1, 0)</td>"),
    ],
)
def test_a_refused_text_stays_with_its_reason_and_its_points(session: Session, text: str, reason: str, points: str) -> None:
    session.type(text)
    session.wait_for_message(reason)
    assert "The maps still show Case I: V = ½(x² + y²) − xy²" in session.panel.message.object
    assert points in session.panel.facts.object or points in session.panel.message.object
    assert not text or text not in session.panel.message.object or text == escape(text)
    assert session.panel.formula.value == text
    assert session.panel.use_well.visible == (text == WELL_ELSEWHERE)
    assert (session.panel.known.value, session.state.system.case) == (TYPED, "I")


def test_a_well_elsewhere_can_be_used(session: Session) -> None:
    assert not session.panel.use_well.visible
    session.type(WELL_ELSEWHERE)
    session.wait_for(lambda: session.panel.use_well.visible)
    session.panel.use_well.clicks += 1
    session.wait_for(lambda: session.state.system.case == TYPED and not session.panel.use_well.visible)
    assert session.panel.formula.value == f"{WELL_ELSEWHERE}; well (1, 0)"
    assert sorted(session.state.potential.terms) == sorted(CASES["I"].terms)
    assert "alert" not in session.panel.message.object
    assert "x and y count from the well at (1, 0)" in session.panel.facts.object


def test_messages_beside_a_refused_text_disappear_with_the_text(session: Session) -> None:
    text = session.panel.formula.value
    leave: list[Callable[[], None]] = [
        lambda: session.type(text, enter=False),
        lambda: session.panel.known.param.update(value="I"),
        lambda: session.state.show_system(review_for_page(System("III"))),
    ]
    for act, exits in zip(leave, (2, 2, 4), strict=True):
        session.type(WELL_ELSEWHERE, enter=False)
        session.wait_for(lambda: session.panel.use_well.visible)
        session.type(WELL_ELSEWHERE + " +", enter=False)
        session.wait_for_message("ends where")
        assert (session.panel.facts.object, session.panel.use_well.visible) == ("", False)
        act()
        session.wait_for_message(f"{exits} exits")
        assert "<td>saddle</td>" in session.panel.facts.object
        assert session.panel.known.value == session.state.system.case
    assert session.state.system.case == "III"


def test_a_known_potential_can_be_selected(session: Session) -> None:
    session.panel.known.value = "C5"
    session.wait_for(lambda: session.state.system.case == "C5")
    assert session.state.potential.channels == 5
    assert session.state.energy == pytest.approx(0.45)


def test_a_slider_keeps_the_ratio_to_the_escape_energy_and_its_last_number(session: Session) -> None:
    later = {"name": "epsilon", "value": 0.7, "count": 2, "done": True}
    session.state.param.watch(lambda event: send(session.panel.sliders, later), "system")
    session.slide("epsilon", 0.5, done=False)
    session.wait_for(lambda: session.state.system.parameters.get("epsilon") == 0.7)
    assert session.sliders()["epsilon"].items() >= {"value": 0.7, "count": 2}.items()
    ratio = session.state.energy / session.state.potential.escape_energy
    assert ratio == pytest.approx(0.25 / CASES["I"].escape_energy, rel=1e-2)


def shown_letters(session: Session) -> dict[str, tuple[float, float]]:
    """Return number and upper end of each slider of a letter."""
    return {name: (row["value"], row["high"]) for name, row in session.sliders().items() if name not in WELL_PARAMETERS}


def test_letters_of_a_formula_have_sliders_with_ranges_that_remain(session: Session) -> None:
    session.type("½(x² + y²) − a x²y + b y³/3")
    assert shown_letters(session) == {"a": (1.0, 2.0), "b": (1.0, 2.0)}
    session.wait_for(lambda: session.state.system.case == TYPED)
    session.slide("b", -7.0)
    session.wait_for(lambda: session.state.system.parameters == {"b": -7.0})
    session.type("½(x² + y²) + b y³/3 − c xy²")
    assert shown_letters(session) == {"b": (-7.0, 2.0), "c": (1.0, 2.0)}
    # This number comes from the slider of a letter that the formula no longer has.
    session.type("½(x² + y²) − xy²")
    session.slide("c", 0.3)
    session.wait_for(lambda: session.state.system.formula == "½(x² + y²) − xy²")
    assert session.state.system.parameters == {}


def test_letters_keep_their_sliders_and_values_while_a_text_cannot_be_read(session: Session) -> None:
    formula = "½(x² + y²) − a x²y + b y³/3"
    session.type(formula)
    session.slide("b", -7.0)
    session.wait_for(lambda: session.state.system.parameters == {"b": -7.0})
    session.type(f"{formula}; a = 1.1")
    assert shown_letters(session) == {"a": (1.0, 2.0), "b": (-7.0, 2.0)}
    session.type(f"{formula} + x⁴")
    session.wait_for(lambda: session.state.system.formula == f"{formula} + x⁴")
    assert session.state.system.parameters == {"b": -7.0}


def test_a_typed_formula_keeps_the_parameters_which_can_be_reset(session: Session) -> None:
    session.state.show_system(review_for_page(System("III", parameters={"omega_1": 1.13, "epsilon": 0.5})))
    assert session.sliders()["epsilon"]["value"] == 0.5
    session.panel.reset.clicks += 1
    session.wait_for(lambda: not session.state.system.parameters)
    assert session.state.system.case == "III"
    session.slide("omega_1", 1.13)
    session.type(WEAKER)
    session.wait_for(lambda: session.state.system.case == TYPED)
    assert session.state.system.parameters["omega_1"] == 1.13


def test_typing_starts_from_coefficients_without_rounding_errors(session: Session) -> None:
    session.state.show_system(review_for_page(System("I", parameters={"omega_1": 1.46, "epsilon": 0.7})))
    before = session.state.potential
    session.panel.known.value = TYPED
    session.wait_for(lambda: session.state.system.case == TYPED)
    assert session.state.system.formula == "1.0658x² + y²/2 − 0.7xy²"
    for (i, j, c), (k, m, expected) in zip(sorted(session.state.potential.terms), sorted(before.terms), strict=True):
        assert (i, j) == (k, m)
        assert c == pytest.approx(expected, rel=5e-12)


@pytest.mark.parametrize(
    ("label", "formula"),
    [("+ letter", "½r² + r⁴ + a x y; escape 10"), ("+ body", "½r² + r⁴; escape 10; centre (0, 0) 0.001")],
)
def test_a_button_adds_a_term_before_the_clauses_or_a_clause_behind_them(session: Session, label: str, formula: str) -> None:
    session.type("½r² + r⁴; escape 10")
    session.wait_for(lambda: session.state.system.formula == "½r² + r⁴; escape 10")
    next(button for button in session.panel.additions if button.label == label).clicks += 1
    assert session.panel.formula.shown["value"] == formula
