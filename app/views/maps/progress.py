"""Progress of the map: shares of the outcomes, a sentence, and a button that stops or continues the map, or offers a layer."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from html import escape

import numpy as np
import panel as pn

from app.state.view_state import ViewState
from app.views.components.texts import TextPane
from app.views.components.widgets import button, keep_place
from engine import EscapeMap, Evidence, Fate, MapSpec
from engine.foundations.wording import format_duration, format_number, format_share, format_whole
from engine.slices.axes import highest_energy
from plots.layers.table import LAYERS
from plots.pictures.palette import Palette
from plots.texts.legends import patch

STOP = "Stop"
"""Label of the button while the map is computed."""

CONTINUE = "Continue"
"""Label of the button of a stopped map."""

STOPPED = "stopped"
"""CSS class of the text of a stopped map. Previews of the browser keep this text."""


class ProgressView:
    """Shows the progress of a map.

    Parameters
    ----------
    state
        View state, whose layers the button offers.
    on_cancel, on_resume
        Stop the map, and continue a stopped map.
    """

    def __init__(self, state: ViewState, on_cancel: Callable[[], None], on_resume: Callable[[], None]) -> None:
        self._state = state
        offers = {layer.title: partial(state.switch_layer, name, on=True) for name, layer in LAYERS.items()}
        self._actions: dict[str, Callable[[], None]] = {STOP: on_cancel, CONTINUE: on_resume, **offers}
        # Time in seconds, and undecided share, when the last stage of the integration began; None before that stage.
        self._last_stage: tuple[float, float] | None = None
        self._frame: EscapeMap | None = None
        self._sentence = ""
        self.bar = pn.indicators.Progress(value=0, sizing_mode="stretch_width", height=3, margin=0, css_classes=["progress"])
        self.text = TextPane("", name="progress", margin=0, css_classes=["status"])
        self.button = button(STOP, self._press, margin=0, styles=keep_place(shown=False), css_classes=["solid", "stop"])
        state.param.watch(lambda event: self._write(self._sentence), "palette")

    def layout(self) -> list[pn.viewable.Viewable]:
        """Return the text and the button, which share a line."""
        return [self.text, self.button]

    def start(self) -> None:
        """Show that a map is requested."""
        self._last_stage = self._frame = None
        self._set("Starting …", running=True, button_label=STOP)

    def show_reviewing(self) -> None:
        """Show that the potential of a link is being reviewed."""
        self._set("Reviewing the potential …", running=False)

    def show_compiling(self) -> None:
        """Show that the kernels of the map are being compiled."""
        self._write("Preparing this kind of potential, once, which takes some seconds …")

    def show(self, frame: EscapeMap) -> None:
        """Show the shares of a frame, and the progress of the map or its result."""
        sentence = _describe_result(frame) if frame.complete else f"{_describe_stage(frame)}{self._time_left(frame)}"
        offer = next((layer.title for layer in LAYERS.values() if layer.is_offered(frame)), None)
        self._frame = frame
        self._set(sentence, running=not frame.complete, button_label=offer or (None if frame.complete else STOP))

    def stop(self) -> None:
        """Show that the map is stopped, and offer to continue it."""
        self._set(f"Stopped: {self._sentence}", running=False, button_label=CONTINUE)
        self.text.css_classes = ["status", STOPPED]

    def fail(self) -> None:
        """Show that there is no map."""
        self._frame = None
        self._set("", running=False)

    def _press(self) -> None:
        self._actions[self.button.label]()

    def _time_left(self, frame: EscapeMap) -> str:
        """Estimate the time left from the share of pixels decided so far in the last stage, which takes longest."""
        now = time.monotonic()
        if frame.horizon < frame.spec.t_max:
            self._last_stage = None
            return ""
        if self._last_stage is None:
            self._last_stage = now, frame.undecided
        begin_time, undecided_at_begin = self._last_stage
        if frame.undecided >= undecided_at_begin:
            return ""
        seconds_left = (now - begin_time) * frame.undecided / (undecided_at_begin - frame.undecided)
        return f", about {format_duration(seconds_left)} left"

    def _set(self, sentence: str, *, running: bool, button_label: str | None = None) -> None:
        """Show a sentence, the bar while the map is `running`, and the button if it has a label.

        The parameters of each widget change together, because each change is a message to the browser.
        """
        value = int(100 * self._frame.progress) if self._frame is not None else self.bar.value
        self.bar.param.update(value=value, styles={"opacity": "1" if running else "0"})
        # The stylesheet puts a button of class "stop" over the status line. The text beside an offer needs this space.
        position = "stop" if button_label in (None, STOP, CONTINUE) else "offer"
        styles = keep_place(shown=button_label is not None)
        self.button.param.update(label=button_label or STOP, styles=styles, css_classes=["solid", position])
        self.text.css_classes = ["status"]
        self._write(sentence)

    def _write(self, sentence: str) -> None:
        self._sentence = sentence
        shares = _shares(self._frame, self._state.colours) if self._frame is not None else ""
        is_complete = self._frame is not None and self._frame.complete
        self.text.object = f"{shares}<div class='{'' if is_complete else 'under-way'}'>{sentence}</div>"


def _shares(frame: EscapeMap, palette: Palette) -> str:
    """Return a bar and a line with the share of each outcome of the interior starts, in the colours of the basins."""
    shares = frame.fractions()
    entries = palette.legend_entries(frame.spec.outcomes) | {Fate.BOUNDED: palette.outcomes[Fate.BOUNDED]}
    if shares[Fate.FAILED]:
        entries[Fate.FAILED] = palette.outcomes[Fate.FAILED]
    closed = {fate: entries.pop(fate).label for fate in _closed_exits(frame.spec) if fate in entries}
    entry_shares = [(entry, shares[fate]) for fate, entry in entries.items()]
    parts = "".join(f"<i style='flex-grow:{share:.4f};background:{entry.colour}'></i>" for entry, share in entry_shares)
    rest = "" if frame.complete else f"<i style='flex-grow:{frame.undecided:.4f}'></i>"
    words = "".join(patch(entry.colour, f"{escape(entry.label)}&nbsp;{format_share(share)}") for entry, share in entry_shares)
    closed_words = f"<span class='quiet'>closed: {escape(', '.join(closed.values()))}</span>" if closed else ""
    return f"<div class='share-bar' aria-hidden='true'>{parts}{rest}</div><div class='legend'>{words}{closed_words}</div>"


def _closed_exits(spec: MapSpec) -> list[int]:
    """Return the numbers of the exits that are closed at all energies of a map; none if the potential differs between starts."""
    if spec.plane.parameter is not None:
        return []
    open_channels = spec.potential.well.open_channels(highest_energy(spec.energy))
    return [channel for channel in range(1, spec.potential.channels + 1) if channel not in open_channels]


def _describe_stage(frame: EscapeMap) -> str:
    """Describe the decided share of an unfinished frame, and the time reached."""
    picture = "" if frame.stride == 1 else "Coarse picture, "
    decided = f"{picture}{format_share(1.0 - frame.undecided)} decided"
    return f"{decided[0].upper()}{decided[1:]}, t = {format_whole(frame.horizon)} of {format_whole(frame.spec.t_max)}"


def _describe_result(frame: EscapeMap) -> str:
    """Return the integration time of a complete map, a warning if needed, and details that open on demand."""
    details = (
        f"Shares of the interior starts, integrated until t = {format_whole(frame.spec.t_max)}{_share_on_evidence(frame)}. "
        f"The relative energy error is at most {format_number(frame.worst_energy_error, 2)}."
    )
    return (
        f"✓ t = {format_whole(frame.spec.t_max)} <button type='button' class='term' popovertarget='map-details'>details</button>"
        f"{_rounding_warning(frame)}<div id='map-details' class='help-text' popover>{details}</div>"
    )


def _rounding_warning(frame: EscapeMap) -> str:
    """Return a warning if double precision does not resolve the pixels of a deep zoom."""
    if not frame.is_rounded:
        return ""
    assert frame.rounded_share is not None
    share = format_share(frame.rounded_share, 0)
    return f"<br>At the limit of double precision: about {share} of the pixels depend on rounding errors."


def _share_on_evidence(frame: EscapeMap) -> str:
    """Return the share of the bounded orbits that are known to be bounded before t_max; empty if there are none."""
    evidence = frame.evidence[frame.fate == Fate.BOUNDED]
    is_early = ~np.isin(evidence, (Evidence.NONE, Evidence.INTEGRATED))
    return f"; {format_share(np.mean(is_early), 0)} of the bounded orbits are known by evidence" if is_early.any() else ""
