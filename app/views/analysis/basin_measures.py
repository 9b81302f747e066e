"""Measures of a map. Quick measures are computed for each map, slow measures on demand."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from html import escape
from typing import Any

import panel as pn

from app.state.glossary import with_terms
from app.state.view_state import ViewState
from app.views.components.charts import ChartView
from app.views.components.collapsible_section import Build
from app.views.components.texts import TextPane
from app.views.components.widgets import COUNT_WHOLE, button, copy_button, number_rows
from engine import MEASURES, Measure, Result, Window
from engine.foundations.wording import format_decimals, format_number
from engine.measures.measure import Quantity
from engine.results import DecayLaws, UncertaintyExponent
from plots.studies.measure_charts import PAIRS, SURVIVAL, pairs_chart, survival_chart

DESCRIBED_MEASURES: tuple[Measure[Any], ...] = tuple(measure for measure in MEASURES.values() if measure.sentence is not None)
"""The measures that the page describes in words, in order."""


def counts_in_box(measure: Measure[Any]) -> bool:
    """Whether a measure counts the starts in the box. The `place` of any other measure says what it counts."""
    return not measure.place


_COMPUTING_ORBITS = "Computing further orbits …"
_UNDEFINED = "Not defined for this map."


class BasinMeasuresView:
    """Shows charts, and a table of the numbers of each measure with descriptions that open on demand.

    Parameters
    ----------
    state
        View state. Its box is the region of the measures.
    on_measure
        Computes the slow measure of this name.
    on_copy
        Copies the numbers, given as tab-separated text.
    """

    def __init__(self, state: ViewState, on_measure: Callable[[str], None], on_copy: Callable[[str], None]) -> None:
        slow = [measure for measure in DESCRIBED_MEASURES if measure.slow]
        self.buttons = {one.name: button(f"Measure the {one.title.lower()}", partial(on_measure, one.name)) for one in slow}
        self.count_whole = button(COUNT_WHOLE, lambda: state.param.update(box=None))
        self.text = TextPane("", name="measures", sizing_mode="stretch_width")
        self.copy = copy_button(self._rows, on_copy)
        self._sentences: dict[str, str] = {}
        self._results: dict[str, Result] = {}
        self.survival = ChartView(SURVIVAL)
        self.uncertainty = ChartView(PAIRS)
        state.follow(self._follow_box, "box")

    def begin(self) -> None:
        """Remove the measures of the previous map."""
        self._remove([*self._sentences])

    def _follow_box(self, box: Window | None) -> None:
        """Name the region of the measures, the whole view for None, and remove slow measures of the previous region."""
        self.count_whole.visible = box is not None
        self._remove([measure.name for measure in DESCRIBED_MEASURES if measure.slow and counts_in_box(measure)])

    def show(self, name: str, result: Any) -> None:
        """Show the result of a measure; None if the measure is not defined for the map."""
        if name in self.buttons:
            self.buttons[name].disabled = False
        if result is None:
            self.say(name, _UNDEFINED)
            return
        sentence = MEASURES[name].sentence
        assert sentence is not None
        self._results[name] = result
        self._draw(result)
        self._set_sentence(name, sentence(result))

    def wait_for(self, name: str) -> None:
        """Show that a slow measure is being computed."""
        self.buttons[name].disabled = True
        self._set_sentence(name, _COMPUTING_ORBITS)

    def say(self, name: str, sentence: str) -> None:
        """Show why a measure has no result."""
        self._remove([name])
        self._set_sentence(name, sentence)

    def parts(self) -> list[Build]:
        """Return functions that make the parts of the section."""
        return [self._build_texts, lambda: [self.survival.build()], lambda: [self.uncertainty.build()]]

    def _build_texts(self) -> list[pn.viewable.Viewable]:
        return [pn.Column(self.text, self.count_whole, self.copy, *self.buttons.values(), margin=0)]

    def _remove(self, names: list[str]) -> None:
        for name in names:
            self._sentences.pop(name, None)
            if isinstance(self._results.pop(name, None), UncertaintyExponent):
                self.uncertainty.show(None)
            if name in self.buttons:
                self.buttons[name].disabled = False
        self._write()

    def _draw(self, result: Result) -> None:
        """Draw a result that has a chart. The survival curve of the last map stays until the next curve arrives."""
        if isinstance(result, UncertaintyExponent):
            self.uncertainty.show(pairs_chart(result))
        elif isinstance(result, DecayLaws):
            self.survival.show(survival_chart(result) if result.times.size else None)

    def _set_sentence(self, name: str, sentence: str) -> None:
        self._sentences[name] = sentence
        self._write()

    def _rows(self) -> list[tuple[str, str, str]]:
        """Return the numbers of all measures, at full precision."""
        results = [(one.title, self._results[one.name]) for one in DESCRIBED_MEASURES if one.name in self._results]
        return [row for title, result in results for row in number_rows(title, result.numbers())]

    def _write(self) -> None:
        region = "In the box drawn on the maps" if self.count_whole.visible else "In the whole view"
        described = [(one, self._sentences[one.name]) for one in DESCRIBED_MEASURES if one.name in self._sentences]
        body = "".join(_measure_section(measure, self._results.get(measure.name), sentence) for measure, sentence in described)
        table = f"<table aria-label='measures'><caption>{region}</caption>{body}</table>" if body else ""
        details = (f"<p id='details-{one.name}' class='help-text' popover>{escape(sentence)}</p>" for one, sentence in described)
        self.text.object = with_terms(f"{table}{''.join(details)}")


def _measure_section(measure: Measure[Any], result: Any, sentence: str) -> str:
    """Return the title and meaning of a measure, and a row for each number; without numbers, the sentence about the result."""
    texts = [] if result is None else [(quantity.label, _format_quantity(quantity, result)) for quantity in measure.quantities]
    numbers = {label: text for label, text in texts if label and text}
    details = f" <button type='button' class='term' popovertarget='details-{measure.name}'>details</button>"
    place = f", {measure.place}" if measure.place else ""
    description = "" if numbers else f"<br>{escape(sentence)}"
    head = f"<b>{measure.title}</b>{details if numbers else ''}<br>{measure.meaning}{place}{description}"
    # Each row divides its width by itself: a long number beside a short label, and a long label beside a short number.
    pairs = (f"<div class='pair'><span>{label}</span> <span>{text}</span></div>" for label, text in numbers.items())
    rows = "".join(f"<tr><td>{pair}</td></tr>" for pair in pairs)
    return f"<tbody><tr><th>{head}</th></tr>{rows}</tbody>"


def _format_quantity(quantity: Quantity[Any], result: Any) -> str:
    """Return a number with its error or its interval; empty if the number is not known."""
    value_and_bars = quantity.read(result)
    value, *bars = value_and_bars if isinstance(value_and_bars, tuple) else (value_and_bars,)
    if not math.isfinite(value):
        return ""
    match bars:
        case [error] if error > 0.0:
            decimals = max(0, -math.floor(math.log10(error)))
            return f"{format_decimals(value, decimals)} ± {format_number(error, 1)}"
        case [low, high]:
            return f"{format_number(value, 3)} ({format_number(low, 3)} to {format_number(high, 3)})"
    return format_number(value)
