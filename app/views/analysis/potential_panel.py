"""The choice of potential: known ones by name, a typed one, their parameters, and the properties that follow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from html import escape
from typing import Any

import panel as pn

from app.rendering.mathml import potential_formula
from app.state.system import TYPED, System
from app.views.components.collapsible_section import CollapsibleSection
from app.views.components.widgets import Slider, button
from engine import FREQUENCIES, LONGEST_TEXT, POTENTIALS, PotentialReview, write_formula

PARAMETERS = {"omega_1": "ω1", "omega_2": "ω2", "epsilon": "ε"}

# Ends of the sliders; links and the command line allow wider ranges.
_SLIDER = (max(FREQUENCIES[0], 0.2), 2.0)
_STEP = 0.01
_PLACEHOLDER = "½(x² + y²) − x²y + y³/3"
_HINT = "Numbers, x, y, r² and + − * / ^ ( ), for example 0.5(x^2+y^2) - x^2 y. Enter applies it."


class PotentialPanel:
    """Widgets of the choice.

    Parameters
    ----------
    review
        Called with the system that is being typed.
    apply
        Called with the system that is chosen.
    """

    def __init__(self, review: Callable[[System], None], apply: Callable[[System], None]) -> None:
        self._review, self._apply = review, apply
        self._system = System("I")
        known = {f"{entry.title}: {entry.description}": name for name, entry in POTENTIALS.items()}
        self.known = pn.widgets.Select(
            label="Potential", options={**known, "Typed": TYPED}, value="I", sizing_mode="stretch_width"
        )
        self.formula = pn.widgets.TextInput(
            label="V(x, y) =", placeholder=_PLACEHOLDER, sizing_mode="stretch_width", max_length=LONGEST_TEXT
        )
        self.sliders = {
            name: Slider(
                label=label, start=_SLIDER[0], end=_SLIDER[1], step=_STEP, value=1.0, format="0.00", sizing_mode="stretch_width"
            )
            for name, label in PARAMETERS.items()
        }
        self.reset = button("Reset to 1", lambda: self._apply(System(self._system.case, self._system.formula)))
        self.message = pn.pane.HTML("", name="potential-message", sizing_mode="stretch_width")
        self.facts = pn.pane.HTML("", name="potential-facts", sizing_mode="stretch_width")
        self.section = CollapsibleSection(self._build, "potential")
        self._connect()

    def _build(self) -> list[pn.viewable.Viewable]:
        hint = pn.pane.HTML(f"<span class='quiet'>{_HINT}</span>", margin=(0, 10), sizing_mode="stretch_width")
        parameters = pn.pane.HTML("V = ½(ω1² x² + ω2² y²) + ε V1", margin=(8, 10, 0, 10), sizing_mode="stretch_width")
        return [self.known, self.formula, hint, self.message, parameters, *self.sliders.values(), self.reset, self.facts]

    def follow(self, system: System) -> None:
        """Show the system of the view state."""
        self._system = system
        self.known.value = system.case
        text = system.formula if system.case == TYPED else POTENTIALS[system.case].formula
        self.formula.param.update(value=text, value_input=text)
        for name, slider in self.sliders.items():
            slider.value = min(max(getattr(system, name), slider.start), slider.end)
        self.reset.disabled = not system.changed

    def show(self, review: PotentialReview, problem: str | None) -> None:
        """Show the properties of a potential, and why it cannot be used."""
        if problem is not None:
            self.say(problem)
        else:
            self.message.object = ""
        self.facts.object = _summary(review) + _points(review) + _remarks(review)

    def say(self, sentence: str) -> None:
        """Show why the choice is invalid."""
        self.message.object = f"<div class='alert' role='alert'>{escape(sentence)}</div>"

    def _connect(self) -> None:
        self.known.param.watch(lambda event: self._choose(event.new), "value")
        self.formula.param.watch(lambda event: self._type(event.new), "value_input")
        self.formula.param.watch(lambda event: self._enter(event.new), "value")
        for name, slider in self.sliders.items():
            slider.param.watch(lambda event, name=name: self._slide(name, event.new), "value_throttled")

    def _choose(self, case: str) -> None:
        if case == self._system.case:
            return
        # A typed potential starts from the formula of the previous one.
        formula = write_formula(self._system.potential) if case == TYPED else ""
        self._apply(System(case, formula))

    def _type(self, text: str) -> None:
        if text.strip() and text != self._text():
            self._review(System(TYPED, text))

    def _enter(self, text: str) -> None:
        if text.strip() and text != self._text():
            self._apply(System(TYPED, text))

    def _text(self) -> str:
        """The formula of the system in view, without its parameters."""
        system = self._system
        return system.formula if system.case == TYPED else POTENTIALS[system.case].formula

    def _slide(self, name: str, value: Any) -> None:
        shown = min(max(getattr(self._system, name), _SLIDER[0]), _SLIDER[1])
        if value is not None and value != shown:
            self._apply(System(**(asdict(self._system) | {name: float(value)})))


def _summary(review: PotentialReview) -> str:
    """The formula, and the number of channels."""
    exits = (
        f"{review.channels} channels above the escape energy h = {review.escape_energy:.6g}" if review.channels else "no channels"
    )
    return f"<div style='font-size:18px'>{potential_formula(review.potential)}</div><p>{exits}</p>"


def _points(review: PotentialReview) -> str:
    """A table of the critical points."""
    rows = "".join(
        f"<tr><td>{point.kind.value}</td><td>({point.x:.6g}, {point.y:.6g})</td>"
        f"<td>{point.energy:.6g}</td><td>{point.channel or ''}</td></tr>"
        for point in review.critical_points
    )
    names = ("critical point", "(x, y)", "V", "channel")
    head = "".join(f"<th scope=col>{name}</th>" for name in names)
    return f"<table><tr>{head}</tr>{rows}</table>" if rows else ""


def _remarks(review: PotentialReview) -> str:
    return "".join(f"<p class='quiet'>{escape(remark)}</p>" for remark in review.remarks)
