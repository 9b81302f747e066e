"""The section "Figure" of the downloads: the choice of a figure, its format and its size."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Sequence
from functools import partial
from html import escape

import panel as pn

from app.browser.components.file_components import FileSaver, ImageCopier
from app.browser.inputs.counted_inputs import NumberBox
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.components.texts import StatusPane
from app.views.components.widgets import SegmentedControl, Switches, button, flex_row
from engine import EscapeMap
from engine.slices.axes import highest_energy
from plots.layers.table import LAYERS_BY_PICTURE, TITLES
from plots.printed.figure_files import (
    map_figure_bytes,
    orbits_figure_bytes,
    statistics_figure_bytes,
    study_figure_bytes,
    well_figure_bytes,
)
from plots.printed.figure_style import POSTER, FigureFormat, FigureStyle
from plots.studies.table import STUDIES

Make = Callable[[FigureFormat, FigureStyle], bytes]
"""Makes the content of a figure's file. This takes seconds."""

Send = Callable[[str, bytes | None], None]
"""Sends the name and the content of a file to the browser. The content is None if there is an error."""

# Titles of the figures that are not single maps.
ALL_MAPS, WELL, ORBITS, STATISTICS = "All maps", "The well in (x, y)", "Orbits", "Statistics"
FIGURES = (
    ALL_MAPS,
    *(title for name, title in TITLES.items() if name != "curves"),
    *(WELL, ORBITS, STATISTICS),
    *(study.figure for study in STUDIES.values()),
)
"""Titles of all figures, in the order of the list."""

# Option of the switch for titles and provenance.
_TITLES = "Titles"
# Label and step of the boxes for the numbers of the style.
_NUMBERS = {"width": ("Width, cm", 0.5), "dpi": ("Pixels/inch", 50.0), "font_size": ("Letters, pt", 0.5)}
# Message while a figure is made.
_MAKING = "The figure is made …"


class FigureForm:
    """Widgets that choose a figure, and buttons that make it.

    Parameters
    ----------
    state, results
        State and results of the session.
    saver
        Sends files to the browser.
    file_name
        Returns the name of a file, given the end of the name.
    on_copied
        Handles whether the browser has copied the image.
    """

    def __init__(
        self,
        state: ViewState,
        results: ShownResults,
        saver: FileSaver,
        file_name: Callable[[str], str],
        on_copied: Callable[[bool], None],
    ) -> None:
        self._state, self._results, self._saver, self._file_name = state, results, saver, file_name
        self._style: dict[str, float] = {name: getattr(FigureStyle(), name) for name in _NUMBERS}
        self.what = pn.widgets.Select(label="What to draw", options=[ALL_MAPS], sizing_mode="stretch_width", margin=(0, 10))
        formats = {format.name: format for format in FigureFormat}
        self.format = SegmentedControl(label="Format", options=formats, value=FigureFormat.PNG, margin=(6, 10))
        self.titles = Switches(label="Titles and provenance", options=[_TITLES], value=[_TITLES], margin=(6, 10))
        self.save = button("Save figure", self._on_save, kind="primary", margin=(5, 10, 5, 0))
        self.poster = button("Save poster", self._on_poster, margin=(5, 10, 5, 0))
        self.copy = ImageCopier(self._on_copy, on_copied, margin=(5, 0))
        self.text = StatusPane("", margin=(0, 10), css_classes=["quiet"])
        results.param.watch(lambda *events: self._offer(), ["frame", "analyses", "orbits", "studies"])
        self.what.param.watch(lambda event: self._enable(), "value")
        self._offer()

    def build(self) -> list[pn.viewable.Viewable]:
        """Make the parts of a column."""
        boxes = [
            NumberBox(
                partial(self.set_number, name), self._style[name], label=label, step=step, min_width=60, margin=(0, 14, 0, 0),
                sizing_mode="stretch_width",
            )
            for name, (label, step) in _NUMBERS.items()
        ]  # fmt: skip
        numbers = pn.Row(*boxes, margin=0, sizing_mode="stretch_width")
        return [self.what, self.format, numbers, self.titles, flex_row(self.save, self.poster, self.copy), self.text]

    def _offer(self) -> None:
        """Offer the figures that the results allow. Keep the chosen figure, because the next map may allow it again."""
        offered = {ALL_MAPS, self.what.value, *figure_choices(self._results, self._state)}
        self.what.options = [title for title in FIGURES if title in offered]
        self._enable()

    def _enable(self) -> None:
        """Enable the buttons if the results allow the chosen figure; otherwise say why they are disabled."""
        title = self.what.value
        disabled = title not in figure_choices(self._results, self._state)
        if disabled or self.save.disabled:
            self._show_text(f"{title}: this is not computed yet." if disabled else "")
        self.save.disabled = self.poster.disabled = self.copy.disabled = disabled

    def style(self) -> FigureStyle | None:
        """Return the style. If a number is not in its range, show the error and return None."""
        try:
            return FigureStyle(**self._style, titles=bool(self.titles.value))
        except ValueError as error:
            self._show_text(str(error))
            return None

    def figure(self) -> tuple[str, Make] | None:
        """Return the file name and the function that makes the chosen figure; None if the results do not allow it."""
        title = self.what.value
        make = figure_choices(self._results, self._state).get(title)
        if make is None:
            return None
        ending = "" if title == ALL_MAPS else "-" + re.sub(r"\W+", "-", title.lower()).strip("-")
        return self._file_name(ending), make

    def set_number(self, name: str, number: float) -> None:
        """Set one of the numbers of the style."""
        self._style[name] = number

    def _on_save(self) -> None:
        self._begin(self.format.value, self.style(), self._send_file)

    def _on_poster(self) -> None:
        self._begin(FigureFormat.PNG, POSTER, lambda name, content: self._send_file(f"poster-{name}", content))

    def _on_copy(self) -> None:
        self._begin(FigureFormat.PNG, self.style(), lambda name, content: self.copy.send(content))

    def _send_file(self, name: str, content: bytes | None) -> None:
        if content is not None:
            self._saver.save(name, content)

    def _begin(self, format: FigureFormat, style: FigureStyle | None, send: Send) -> None:
        """Make the figure from the present results, and send it, or show an error. That of a missing style is shown already."""
        figure = self.figure()
        if figure is None or style is None:
            send("", None)
            return
        name, make = figure
        pn.state.execute(partial(self.make, partial(make, format, style), partial(send, f"{name}.{format}")))

    async def make(self, make: Callable[[], bytes], send: Callable[[bytes | None], None]) -> None:
        """Make a file in a thread, to keep the event loop free, and send it. After an error, show the error and send None."""
        self._show_text(_MAKING)
        try:
            content = await asyncio.to_thread(make)
        except ValueError as error:
            self._show_text(str(error))
            send(None)
        else:
            self._show_text("")
            send(content)

    def _show_text(self, sentence: str) -> None:
        self.text.object = escape(sentence)


def figure_choices(shown: ShownResults, state: ViewState) -> dict[str, Make]:
    """Return the figures that the results allow, by title. Later changes of the page do not change the figures."""
    choices: dict[str, Make] = {}
    curves = [one.curves for one in shown.orbits if one.curves is not None]
    frame = shown.whole_map
    drawn_map = shown.drawn_map
    if frame is not None and drawn_map is not None:
        choices |= _map_choices(drawn_map, shown, state)
        spec = frame.spec
        energy = highest_energy(spec.energy)
        choices[WELL] = partial(well_figure_bytes, spec.potential, energy, curves, state.colours)
    if curves:
        verdicts = [one.describe() for one in shown.orbits if one.curves is not None]
        choices[ORBITS] = partial(orbits_figure_bytes, state.potential, curves, state.colours, verdicts)
    if frame is not None:
        choices[STATISTICS] = partial(statistics_figure_bytes, frame, state.box)
    for name, found in shown.studies.items():
        if STUDIES[name].progress(found):
            choices[STUDIES[name].figure] = partial(study_figure_bytes, STUDIES[name], found, state.settings)
    return choices


def _map_choices(frame: EscapeMap, shown: ShownResults, state: ViewState) -> dict[str, Make]:
    analyses, orbits = shown.analyses, shown.orbits
    without_result = {picture for picture, layer in LAYERS_BY_PICTURE.items() if layer.name not in analyses}
    pictures = [name for name in TITLES if name not in {"curves", *without_result}]

    def make(names: Sequence[str], format: FigureFormat, style: FigureStyle) -> bytes:
        return map_figure_bytes(frame, names, palette, format, style, analyses=analyses, starts=starts, times=times)

    palette, times, starts = state.colours, state.lock_times, tuple(one.start for one in orbits)
    choices: dict[str, Make] = {ALL_MAPS: partial(make, pictures)}
    return choices | {TITLES[name]: partial(make, [name]) for name in pictures}
