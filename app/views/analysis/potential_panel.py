"""The choice of the potential: known potentials by name, a typed formula, parameters, and the resulting properties."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from html import escape
from itertools import batched
from typing import Protocol

import panel as pn

from app.browser.inputs.counted_inputs import FormulaBox, ParameterSliders, SliderParameter
from app.state.system_review import PageReview
from app.views.components.collapsible_section import Build
from app.views.components.texts import StatusPane, TextPane, describe_outcomes, plain_symbol
from app.views.components.widgets import button, flex_row
from engine import System
from engine.foundations.wording import format_number, format_point
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.formulas.formula_parser import LARGEST_VALUE, LONGEST_TEXT, formula_letters
from engine.systems.parameters import WELL_PARAMETERS
from engine.systems.system import TYPED
from plots.pictures.palette import MOST_CHANNELS
from plots.texts.mathml import potential_symbol

# Ends of the sliders of most parameters. Boxes, links and the command line allow wider ranges.
_SLIDER_ENDS = (0.2, 2.0)
# Ends of the other sliders.
_OTHER_SLIDER_ENDS = {"rotation": (-1.0, 1.0)}
# Smallest distance of the ends of a letter's slider from 0. For a large initial value, the distance is twice that value.
_SMALLEST_REACH = 2.0
# Number of views that are added to the page in one iteration of the event loop. A view takes about 10 ms, and the search of the
# page for new models as much as four.
_VIEWS_OF_PART = 5
_PLACEHOLDER = "½(x² + y²) − x²y + y³/3"
_HINT = (
    f"Numbers, x, y, r², √, exp, log, sin, cos, letters with sliders, and + − * / ^ ( ), at most {LONGEST_TEXT} characters, "
    "for example 0.5(x^2+y^2) - a x^2 y. “; well (1, 0)” moves the axes to the minimum near (1, 0); “; masses (8, 8)” "
    "is for masses of 8."
)
# Terms that buttons add to the formula, by label of the button.
_TERMS = {"+ letter": " + a x y"}
# Clauses that buttons add after all terms, by label of the button.
_CLAUSES = {"+ body": "; centre (0, 0) 0.001", "+ escape radius": "; escape 10"}
OUTDATED = "outdated"
"""CSS class of properties of the formula before the last change."""
NEW_INTEGRATOR = "Press Enter to use it: an integrator for its form and its outcomes is compiled first, which takes some seconds."
"""Note about a formula that the maps do not show before Enter is pressed."""

_DEFINITION = "V = ½(ω₁²x² + ω₂²y²) + ε V₁, and Φ = V − ½Ω²(x² + y²) in a frame that rotates at the rate Ω"


class Propose(Protocol):
    """Receives the system of the widgets."""

    def __call__(self, system: System, *, done: bool) -> None:
        """Take a system; `done` is False while the visitor is typing or dragging."""


class PotentialPanel:
    """Widgets that propose a potential, and show the properties of the proposal.

    Parameters
    ----------
    used
        The review of the system of the maps.
    propose
        Receives each system that is chosen, typed, or set by a slider.
    on_rest
        Called when the view has been at rest for a while.
    """

    def __init__(self, used: PageReview, propose: Propose, on_rest: Callable[[], None] = lambda: None) -> None:
        self._propose = propose
        self._offered_well: tuple[float, float] | None = None
        self.used = used
        """The review of the system of the maps."""
        self.shown = used.system
        """The system of the widgets, which may differ from the system of the maps."""
        names = {f"{entry.title}: {entry.description}": name for name, entry in CATALOGUE.items()}
        self.known = pn.widgets.Select(
            label="Potential", options={**names, "Typed": TYPED}, value="I", sizing_mode="stretch_width", margin=(5, 0)
        )
        self.formula = FormulaBox(
            self._take_text, "", label="V(x, y) =", placeholder=_PLACEHOLDER, sizing_mode="stretch_width", margin=(5, 0)
        )
        self.typeset = TextPane("", css_classes=["typeset"], sizing_mode="stretch_width", margin=0)
        self.message = StatusPane(
            "", name="potential-message", css_classes=["potential-message"], sizing_mode="stretch_width", margin=0
        )
        self.use_well = button("Use this well", self._use_well, visible=False, margin=(8, 0))
        self.additions = [
            *(button(label, partial(self._add, term=term), margin=0) for label, term in _TERMS.items()),
            *(button(label, partial(self._add, clause=clause), margin=0) for label, clause in _CLAUSES.items()),
        ]
        self.sliders = ParameterSliders(self._slide, on_rest, sizing_mode="stretch_width", margin=0)
        # Half the range of the slider of each letter, and the values of all sliders.
        self._reaches: dict[str, float] = {}
        self._values: dict[str, float] = {}
        reset = lambda: self._choose(System(self.shown.case, self.shown.formula))  # noqa: E731
        self.reset = button("Reset parameters", reset, margin=(8, 0))
        self.definition = TextPane(_DEFINITION, margin=(8, 0), sizing_mode="stretch_width")
        self.facts = TextPane("", sizing_mode="stretch_width", margin=0)
        self._show(used.system)
        self.known.param.watch(lambda event: self._take_known(event.new), "value")

    def parts(self) -> list[Build]:
        """Return the makers of a column's parts, parts of fixed height first: no part moves while the formula is typed."""
        buttons = flex_row(self.reset, self.use_well, gap="8px")
        views = [
            *(self.known, self.formula, self.typeset, self.message, flex_row(*self.additions)),
            *(self.definition, self.sliders, buttons, self.facts),
        ]
        return [partial(list, part) for part in batched(views, _VIEWS_OF_PART)]

    def _show_sliders(self) -> None:
        """Show a slider for each parameter, letters first. A letter that remains in the formula keeps the range of its slider.

        While the letters of a text cannot be read, the sliders of the last text stay, because the letters probably return.
        """
        if not _has_readable_letters(self.shown):
            return
        self._values = values = {name: self.shown.value_of(name) for name in self.shown.parameter_names}
        first_reaches = {name: max(_SMALLEST_REACH, 2.0 * abs(values[name])) for name in _letters_of(self.shown)}
        self._reaches = {name: self._reaches.get(name, reach) for name, reach in first_reaches.items()}
        self.sliders.show(
            {
                **{_letter_parameter(name, reach): values[name] for name, reach in self._reaches.items()},
                **{_well_parameter(name): values[name] for name in WELL_PARAMETERS if name in values},
            }
        )

    def follow(self, used: PageReview) -> None:
        """Show the system of the maps."""
        self.used = used
        self._show(used.system)
        self.show(used)

    def show(self, reviewed: PageReview, note: str = _HINT) -> None:
        """Show the properties of the system of the widgets. Add a note, or the reason why the maps cannot show the system."""
        self._mark_outdated(outdated=False)
        self.typeset.object = reviewed.typeset
        self._write(_accepted(reviewed, note) if reviewed.problem is None else _alert(reviewed.problem))
        self._offer(None if reviewed.problem is None else reviewed.well)
        self.facts.object = _critical_points_table(reviewed) + _remark_paragraphs(reviewed)

    def wait(self) -> None:
        """Show that the system of the widgets is being reviewed, and that the properties are not yet its own."""
        self._write("<p>Reviewing …</p>")
        self._mark_outdated(outdated=True)

    def say(self, sentence: str) -> None:
        """Show why the system of the widgets has no properties."""
        self._write(_alert(sentence))
        self._mark_outdated(outdated=False)
        self._offer(None)
        self.typeset.object = self.facts.object = ""

    def _mark_outdated(self, *, outdated: bool) -> None:
        """Grey out the formula and the facts, or show them normally."""
        for pane in (self.typeset, self.facts):
            others = [each for each in pane.css_classes if each != OUTDATED]
            pane.css_classes = [*others, OUTDATED] if outdated else others

    def _write(self, message: str) -> None:
        """Show a message, and the system of the maps if the widgets have another system."""
        used = self.used
        shows = f"The maps still show {used.system.title}: V = {used.formula}"
        draft = f"<p class='quiet'>{escape(shows)}</p>" if self.shown != used.system else ""
        self.message.object = message + draft

    def _offer(self, well: tuple[float, float] | None) -> None:
        """Offer to move the axes to a well; None offers nothing."""
        self._offered_well = well
        self.use_well.visible = well is not None

    def _choose(self, system: System) -> None:
        """Show a system in all widgets, and propose it."""
        self._show(system)
        self._propose(system, done=True)

    def _show(self, system: System) -> None:
        self.formula.show(_formula_of(system))
        self._show_around_text(system)

    def _show_around_text(self, system: System) -> None:
        """Show a system in all widgets except the formula, which is being typed."""
        self.shown = system
        self.known.value = system.case
        self.definition.visible = "epsilon" in system.parameter_names
        self.reset.disabled = not system.parameters
        self._show_sliders()

    def _take_known(self, case: str) -> None:
        if case == self.shown.case:
            return
        if case == self.used.system.case:
            self._choose(self.used.system)
        else:
            # A typed potential begins with the formula of the previous potential.
            self._choose(self.shown.as_typed if case == TYPED else System(case))

    def _take_text(self, text: str, done: bool) -> None:
        """Propose the system of a typed formula, or the system of the maps if the formula is the same."""
        used = self.used.system
        self._show_around_text(used if text == _formula_of(used) else _typed_system(text, self._values))
        self._propose(self.shown, done=done)

    def _use_well(self) -> None:
        if self._offered_well is not None:
            x, y = self._offered_well
            typed = self.shown.as_typed
            self._choose(replace(typed, formula=f"{typed.formula}; well ({x:.6g}, {y:.6g})"))

    def _add(self, term: str = "", clause: str = "") -> None:
        """Add a term or a clause to the formula."""
        typed = self.shown.as_typed
        terms, semicolon, clauses = typed.formula.partition(";")
        self._choose(replace(typed, formula=f"{terms.rstrip()}{term}{semicolon}{clauses}{clause}"))

    def _slide(self, name: str, number: float, done: bool) -> None:
        """Propose the system with the number of a slider."""
        if not _has_readable_letters(self.shown):
            self._values[name] = number
            return
        self._show_around_text(replace(self.shown, parameters={**self.shown.parameters, name: number}))
        self._propose(self.shown, done=done)


def _letter_parameter(name: str, reach: float) -> SliderParameter:
    return SliderParameter(name, name, -reach, reach, -LARGEST_VALUE, LARGEST_VALUE)


def _well_parameter(name: str) -> SliderParameter:
    symbol, _, legal_range = WELL_PARAMETERS[name]
    return SliderParameter(name, plain_symbol(symbol), *_OTHER_SLIDER_ENDS.get(name, _SLIDER_ENDS), *legal_range)


def _formula_of(system: System) -> str:
    """Return the formula of a system without the values of its parameters."""
    return system.entry.formula


def _letters_of(system: System) -> tuple[str, ...]:
    """Return the parameters of a system that are letters of its formula."""
    return tuple(name for name in system.parameter_names if name not in WELL_PARAMETERS)


def _has_readable_letters(system: System) -> bool:
    try:
        formula_letters(system.formula)
    except ValueError:
        return False
    return True


def _typed_system(text: str, values: Mapping[str, float]) -> System:
    """Return the system of a typed formula with these values of its parameters, or their defaults."""
    typed = System(TYPED, text)
    return replace(typed, parameters={name: values.get(name, typed.default_of(name)) for name in typed.parameter_names})


def _alert(sentence: str) -> str:
    return f"<div class='alert'>{escape(sentence)}</div>"


def _accepted(review: PageReview, note: str) -> str:
    ends = "Orbits end at: " if review.potential.ends else ""
    return f"<p>{ends}{describe_outcomes(review)}</p><p class='quiet'>{escape(note)}</p>"


def _critical_points_table(review: PageReview) -> str:
    """Return a table of the critical points, exits first."""
    rows = "".join(
        f"<tr><td>{point.kind.value}</td><td>{format_point(point.x, point.y, 4)}</td>"
        f"<td>{format_number(point.energy)}</td><td>{point.channel or ''}</td></tr>"
        for point in sorted(review.critical_points, key=lambda point: point.channel or MOST_CHANNELS + 1)
    )
    names = ("point", "(x, y)", potential_symbol(review.potential), "exit")
    head = "".join(f"<th scope=col>{name}</th>" for name in names)
    return f"<table aria-label='critical points'><tr>{head}</tr>{rows}</table>" if rows else ""


def _remark_paragraphs(review: PageReview) -> str:
    return "".join(f"<p class='quiet'>{escape(remark)}</p>" for remark in review.remarks)
