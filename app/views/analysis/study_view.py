"""A study beside the maps: its button, its text and its charts. A click on a chart changes the view."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from html import escape
from typing import Any

import panel as pn
from bokeh.events import Tap
from bokeh.models import Range1d

from app.state.view_state import ViewState
from app.views.components.charts import ChartView
from app.views.components.collapsible_section import InTurns, Later, at_once
from app.views.components.plots import moving_line
from app.views.components.setting_choice import setting_choice
from app.views.components.texts import TextPane, plain_symbol
from app.views.components.widgets import FULL_HEIGHT, button, flex_row
from engine import Result, System
from engine.foundations.wording import format_duration
from engine.systems.parameters import symbol_of
from plots.studies.axes import ENERGY, value_on
from plots.studies.study import Click, Study
from plots.studies.table import STUDIES

STOP = "Stop"
"""Label of the button while a study is computed."""


class StudyView:
    """Shows a study. Its figures are made for the first result.

    Parameters
    ----------
    study
        The study.
    state
        The view state.
    on_button
        Starts or stops the computation when the button is pressed.
    on_click
        Called with a click on a chart.
    later
        Wraps a function that makes a figure, so that it runs in a later iteration of the event loop.
    """

    def __init__(
        self,
        study: Study[Any],
        state: ViewState,
        on_button: Callable[[], None],
        on_click: Callable[[Click], None],
        later: Later = at_once,
    ) -> None:
        self._study, self._state, self._on_click = study, state, on_click
        self.shown: Result | None = None
        self.running = False
        self._start_time = 0.0
        # The axis of the charts that are shown.
        self._shown_axis = ""
        self.button = button(study.button, on_button, width=180, align="end", visible=not study.follows_map)
        self.against = pn.widgets.Select(label="Against", options=[], width=80, visible=False)
        self.text = TextPane(self._hint, name=study.name, margin=(4, 10), sizing_mode="stretch_width", css_classes=["whole-row"])
        self._mark_line = moving_line("height", location=0.0, line_dash="dotted")
        options: dict[str, Any] = {"x_range": Range1d(0.0, 1.0)} if study.axes(state.system) else {}
        self._charts = {each.name: ChartView(each, aspect_ratio=each.aspect, **options) for each in study.frames}
        self._charts_in_turns = InTurns([partial(self._build_chart, chart) for chart in self._charts.values()], self._add, later)
        self._plots = pn.Column(sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=["charts"], visible=False)
        # The study whose tab this one shares has its settings already.
        settings_above = STUDIES[study.tab].settings if study.tab else ()
        self._choices = [setting_choice(state, setting) for setting in study.settings if setting not in settings_above]
        self._row = flex_row(gap="8px", align="end")
        self._row.css_classes = ["whole-row"]
        state.follow(self._follow_system, "system")
        state.follow(lambda energy: self._mark(), "energy")
        state.param.watch(lambda *events: self._redraw(), ["palette", *(["settings"] if study.settings else [])])

    @property
    def _hint(self) -> str:
        follows = " They follow the map." if self._study.follows_map else ""
        return f"{self._study.hint}{follows}{' Computing …' if self.running else ''}"

    @property
    def axis(self) -> str:
        """The chosen axis of the charts; empty for a study without a choice."""
        return self.against.value or ""

    def _redraw(self) -> None:
        if self.shown is not None:
            self.show(self.shown, self._shown_axis)

    def _follow_system(self, system: System) -> None:
        """Offer the axes of a system."""
        labels = {name: name if name == ENERGY else plain_symbol(symbol_of(name)) for name in self._study.axes(system)}
        options = {label: name for name, label in labels.items()}
        # A choice that the new system lacks is replaced by the first one.
        value = self.against.value if self.against.value in labels else next(iter(labels), None)
        self.against.param.update(options=options, value=value, visible=len(options) > 1)
        self._row.objects = self._inputs()

    def _mark(self) -> None:
        """Mark the energy of the view, or the value of the parameter in the system of the view."""
        if self._shown_axis:
            self._mark_line.location = value_on(self._shown_axis, self._state.system, self._state.energy)

    def show_running(self, running: bool) -> None:
        """Label the button with its next action, and say that a first result is being computed."""
        if running and not self.running:
            self._start_time = time.monotonic()
        self.running = running
        self.button.label = STOP if running else self._study.button
        if self.shown is None:
            self.text.object = escape(self._hint)

    def show(self, found: Any, axis: str = "") -> None:
        """Draw the charts of a result about the system in view; None removes them.

        Parameters
        ----------
        found
            The result.
        axis
            The axis of its charts; empty for a study without a choice.
        """
        self.shown, self._shown_axis = found, axis
        self._plots.visible = found is not None
        if found is None:
            self.text.object = escape(self._hint)
            return
        self._charts_in_turns.begin()
        charts = {chart.frame.name: chart for chart in self._study.charts(found, self._state.colours, self._state.settings)}
        for name, view in self._charts.items():
            view.show(charts.get(name))
        self._mark()
        self.text.object = escape(self._describe(found))

    def _describe(self, found: Any) -> str:
        """Return what the charts show. For an incomplete result, estimate the time left from the time since the start."""
        sentence, share = self._study.sentence(found), self._study.progress(found)
        if self._study.is_complete(found):
            return f"{sentence} {self._study.invitation(found)}".rstrip()
        seconds = time.monotonic() - self._start_time
        return f"{sentence} …{f' about {format_duration(seconds * (1.0 - share) / share)} left' if share else ''}"

    def say(self, sentence: str) -> None:
        """Show why there is no result."""
        self.text.object = escape(sentence)

    def build(self) -> list[pn.viewable.Viewable]:
        """Return the button, the text, and the container of the figures. The first result adds the figures."""
        return [self._row, self.text, self._plots]

    def _inputs(self) -> list[pn.viewable.Viewable]:
        """Return the inputs that are shown. Hidden ones would add elements to the page."""
        return [*self._choices, *(each for each in (self.against, self.button) if each.visible)]

    def _build_chart(self, chart: ChartView) -> list[pn.viewable.Viewable]:
        view = chart.build({Tap: lambda event: self._on_click(Click(chart.frame.name, event.x, event.y))})
        assert chart.plot is not None
        if self._shown_axis and not chart.frame.has_tiles:
            chart.plot.add_layout(self._mark_line)
        return [view]

    def _add(self, plots: Sequence[pn.viewable.Viewable]) -> None:
        self._plots.objects = [*self._plots.objects, *plots]
