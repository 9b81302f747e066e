"""The choice of potential: known ones by name, a typed one, their parameters, and the properties that follow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from html import escape
from typing import Any

import panel as pn

from app.state.system_review import SystemReview
from app.views.components.collapsible_section import CollapsibleSection
from app.views.components.widgets import Slider, button
from engine import POTENTIALS, PotentialReview, write_formula
from engine.service import FREQUENCIES, LONGEST_TEXT, PARAMETERS, SHOWN_DIGITS, TYPED, System
from plots.mathml import potential_formula

# Ends of the sliders; links and the command line allow wider ranges.
_SLIDER = (max(FREQUENCIES[0], 0.2), 2.0)
_STEP = 0.01
# A box that cut a longer text at the limit would not say so.
_MOST_TYPED = 200 * LONGEST_TEXT
_PLACEHOLDER = "½(x² + y²) − x²y + y³/3"
_HINT = (
    f"Numbers, x, y, r² and + − * / ^ ( ), at most {LONGEST_TEXT} characters, for example 0.5(x^2+y^2) - x^2 y. Enter applies it."
)


class PotentialPanel:
    """Widgets of the choice.

    Parameters
    ----------
    used
        The system of the maps.
    review
        Called with the system that is being typed.
    apply
        Called with the system that is chosen.
    """

    def __init__(self, used: SystemReview, review: Callable[[System], None], apply: Callable[[System], None]) -> None:
        self._review, self._apply = review, apply
        self._used = used
        self._moved: str | None = None
        self._filling = False
        self.shown = used.system
        """The system of the widgets; that of the maps may be another one."""
        known = {f"{entry.title}: {entry.description}": name for name, entry in POTENTIALS.items()}
        self.known = pn.widgets.Select(
            label="Potential", options={**known, "Typed": TYPED}, value="I", sizing_mode="stretch_width"
        )
        self.formula = pn.widgets.TextInput(
            label="V(x, y) =", placeholder=_PLACEHOLDER, sizing_mode="stretch_width", max_length=_MOST_TYPED
        )
        self.sliders = {
            name: Slider(
                label=label, start=_SLIDER[0], end=_SLIDER[1], step=_STEP, value=1.0, format="0.00", sizing_mode="stretch_width"
            )
            for name, label in PARAMETERS.items()
        }
        self.reset = button("Reset to 1", lambda: self._choose(System(self.shown.case, self.shown.formula)))
        self.message = pn.pane.HTML("", name="potential-message", sizing_mode="stretch_width")
        self.move = button("Use this well, moved to the origin", self._move, visible=False)
        self.facts = pn.pane.HTML("", name="potential-facts", sizing_mode="stretch_width")
        self.section = CollapsibleSection(self._build, "potential")
        self._connect()

    def _build(self) -> list[pn.viewable.Viewable]:
        hint = pn.pane.HTML(f"<span class='quiet'>{_HINT}</span>", margin=(0, 10), sizing_mode="stretch_width")
        parameters = pn.pane.HTML("V = ½(ω1² x² + ω2² y²) + ε V1", margin=(8, 10, 0, 10), sizing_mode="stretch_width")
        text = [self.known, self.formula, hint, self.message, self.move]
        return [*text, parameters, *self.sliders.values(), self.reset, self.facts]

    def follow(self, used: SystemReview) -> None:
        """Show the system of the maps."""
        self._used = used
        self._show(used.system)

    def show(self, review: PotentialReview, problem: str | None) -> None:
        """Show the properties of the potential of the widgets, and why it cannot be used."""
        self._write(_alert(problem) if problem else self._is_draft("Press Enter to use this potential."))
        self._offer(review.moved_formula if problem else None)
        self.facts.object = _summary(review) + _points(review) + _remarks(review)

    def wait(self) -> None:
        """The potential of the widgets is under review."""
        self._write("<p>Reviewing …</p>")

    def say(self, sentence: str) -> None:
        """Show why the potential of the widgets has no properties."""
        self._write(_alert(sentence))
        self._offer(None)
        self.facts.object = ""

    def _write(self, message: str) -> None:
        """Show a message, and what the maps show if it is another potential."""
        used = self._used
        self.message.object = message + self._is_draft(f"The maps still show {used.system.title}: V = {used.formula_shown}")

    def _is_draft(self, sentence: str) -> str:
        """HTML of a sentence if the widgets do not show the potential of the maps, else empty."""
        return f"<p>{escape(sentence)}</p>" if self.shown != self._used.system else ""

    def _offer(self, moved: str | None) -> None:
        self._moved, self.move.visible = moved, moved is not None

    def _connect(self) -> None:
        self.known.param.watch(lambda event: self._take_known(event.new), "value")
        self.formula.param.watch(lambda event: self._take_text(event.new, self._review), "value_input")
        self.formula.param.watch(lambda event: self._take_text(event.new, self._apply), "value")
        for name, slider in self.sliders.items():
            slider.param.watch(lambda event, name=name: self._slide(name, event.new), "value_throttled")

    def _choose(self, system: System) -> None:
        """Show a system in all widgets, and use it."""
        self._show(system)
        self._apply(system)

    def _show(self, system: System) -> None:
        self.shown = system
        self._filling = True
        try:
            self.formula.param.update(value=_text(system), value_input=_text(system))
        finally:
            self._filling = False
        self._show_around_text()

    def _show_around_text(self) -> None:
        """Update all widgets but the text, which is being typed."""
        self.known.value = self.shown.case
        for name, slider in self.sliders.items():
            slider.value = _on_slider(getattr(self.shown, name))
        self.reset.disabled = not self.shown.changed

    def _take_known(self, case: str) -> None:
        if case == self.shown.case:
            return
        if case == self._used.system.case:
            self._choose(self._used.system)
        else:
            # A typed potential starts from the formula of the previous one.
            self._choose(System(case, write_formula(self.shown.potential, SHOWN_DIGITS) if case == TYPED else ""))

    def _take_text(self, text: str, use: Callable[[System], None]) -> None:
        """Review or use the text that the user typed."""
        if self._filling:
            return
        self.shown = self._used.system if text == _text(self._used.system) else System(TYPED, text)
        self._show_around_text()
        use(self.shown)

    def _move(self) -> None:
        if self._moved is not None:
            self._choose(System(TYPED, self._moved))

    def _slide(self, name: str, value: Any) -> None:
        if value is not None and value != _on_slider(getattr(self.shown, name)):
            self._choose(System(**(asdict(self.shown) | {name: float(value)})))


def _text(system: System) -> str:
    """The formula of a system without its parameters."""
    return system.formula if system.case == TYPED else POTENTIALS[system.case].formula


def _on_slider(value: float) -> float:
    return min(max(value, _SLIDER[0]), _SLIDER[1])


def _alert(sentence: str) -> str:
    return f"<div class='alert' role='alert'>{escape(sentence)}</div>"


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
