"""All potentials: known ones by name, one that is typed, the parameters of either, and what follows from them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from html import escape
from typing import Any

import panel as pn
import panel_material_ui as pmui

from app.state.system import TYPED, System
from app.views.components.collapsible_section import Section
from engine import FREQUENCIES, LONGEST_TEXT, POTENTIALS, PotentialReview, typeset, write_formula

PARAMETERS = {"omega_1": "ω1", "omega_2": "ω2", "epsilon": "ε"}

# Where the sliders end; the legal ranges are wider, and reached by links and the command line.
_SLIDER = (max(FREQUENCIES[0], 0.2), 2.0)
_STEP = 0.01
_PLACEHOLDER = "½(x² + y²) − x²y + y³/3"
_HINT = "Numbers, x, y, r² and + − * / ^ ( ), as in 0.5(x^2+y^2) - x^2 y; Enter looks at it and takes it."
_CELL = "padding:1px 14px 1px 0;text-align:left"


class PotentialPanel:
    """`look_at(system)` is told of what is being typed, `take(system)` of what is wanted."""

    def __init__(self, look_at: Callable[[System], None], take: Callable[[System], None]) -> None:
        self._look_at, self._take = look_at, take
        self._system = System("I")
        known = {f"{entry.title}: {entry.description}": name for name, entry in POTENTIALS.items()}
        self.known = pmui.Select(label="Potential", options={**known, "Typed": TYPED}, value="I", size="small", width=520)
        self.formula = pmui.TextInput(
            label="V(x, y) =", placeholder=_PLACEHOLDER, description=_HINT, size="small", width=520, max_length=LONGEST_TEXT
        )
        self.sliders = {
            name: pmui.FloatSlider(label=label, start=_SLIDER[0], end=_SLIDER[1], step=_STEP, value=1.0, format="0.00", width=240)
            for name, label in PARAMETERS.items()
        }
        self.plain = pmui.Button(label="All 1", variant="outlined", size="small")
        self.said = pn.pane.HTML("", name="potential-said", width=520)
        self.facts = pn.pane.HTML("", name="potential-facts", min_width=320, max_width=700, sizing_mode="stretch_width")
        choice = pn.Column(self.known, self.formula, self.said, width=540)
        parameters = pn.Column(*self.sliders.values(), self.plain, width=270, margin=(0, 20))
        self.section = Section("Potential: V = ½(ω1² x² + ω2² y²) + ε V1", (choice, parameters, self.facts), ())
        self._connect()

    def layout(self) -> pn.viewable.Viewable:
        """Where it stands on the page."""
        return self.section.layout()

    def follow(self, system: System) -> None:
        """Stand where the view state stands."""
        self._system = system
        self.known.value = system.case
        text = system.formula if system.case == TYPED else POTENTIALS[system.case].formula
        self.formula.param.update(value=text, value_input=text)
        for name, slider in self.sliders.items():
            slider.value = min(max(getattr(system, name), slider.start), slider.end)
        self.plain.disabled = not system.changed

    def show(self, found: PotentialReview, problem: str | None) -> None:
        """What follows from a potential, and why it cannot be taken."""
        if problem is not None:
            self.say(problem)
        else:
            self.said.object = ""
        self.facts.object = _summary(found) + _points(found) + _remarks(found)

    def say(self, sentence: str) -> None:
        """What is wrong with what was chosen."""
        self.said.object = f"<div role='alert' style='font-size:14px'>{escape(sentence)}</div>"

    def _connect(self) -> None:
        self.known.param.watch(lambda event: self._choose(event.new), "value")
        self.formula.param.watch(lambda event: self._type(event.new), "value_input")
        self.formula.param.watch(lambda event: self._enter(event.new), "value")
        for name, slider in self.sliders.items():
            slider.param.watch(lambda event, name=name: self._slide(name, event.new), "value_throttled")
        self.plain.on_click(lambda event: self._take(System(self._system.case, self._system.formula)))

    def _choose(self, case: str) -> None:
        if case == self._system.case:
            return
        # A typed potential begins with the formula of the last one, to be changed.
        formula = write_formula(self._system.potential) if case == TYPED else ""
        self._take(System(case, formula))

    def _type(self, text: str) -> None:
        if text.strip() and text != self._text():
            self._look_at(System(TYPED, text))

    def _enter(self, text: str) -> None:
        if text.strip() and text != self._text():
            self._take(System(TYPED, text))

    def _text(self) -> str:
        """The formula of the system in view, its parameters left out."""
        system = self._system
        return system.formula if system.case == TYPED else POTENTIALS[system.case].formula

    def _slide(self, name: str, value: Any) -> None:
        shown = min(max(getattr(self._system, name), _SLIDER[0]), _SLIDER[1])
        if value is not None and value != shown:
            self._take(System(**(asdict(self._system) | {name: float(value)})))


def _summary(found: PotentialReview) -> str:
    """The potential as it is meant, and its exits in a line."""
    exits = (
        f"{found.channels} channels above the escape energy h = {found.escape_energy:.6g}" if found.channels else "no channels"
    )
    return f"<div style='font-size:18px'>{typeset(found.potential)}</div><p style='font-size:14px;margin:6px 0'>{exits}</p>"


def _points(found: PotentialReview) -> str:
    """The critical points in a table."""
    rows = "".join(
        f"<tr><td style='{_CELL}'>{point.kind.value}</td><td style='{_CELL}'>({point.x:.6g}, {point.y:.6g})</td>"
        f"<td style='{_CELL}'>{point.energy:.6g}</td><td style='{_CELL}'>{point.channel or ''}</td></tr>"
        for point in found.critical_points
    )
    names = ("critical point", "(x, y)", "V", "channel")
    head = "".join(f"<th scope=col style='{_CELL}'>{name}</th>" for name in names)
    return f"<table style='font-size:13px'><tr>{head}</tr>{rows}</table>" if rows else ""


def _remarks(found: PotentialReview) -> str:
    return "".join(f"<p style='font-size:13px;margin:4px 0'>{escape(remark)}</p>" for remark in found.remarks)
