"""Progress of the map: a bar, a line of text, and the button that stops or continues it, or offers a layer."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from functools import partial
from html import escape

import numpy as np
import panel as pn

from app.state.glossary import with_terms
from app.views.components.numbers import percent
from app.views.components.texts import TextPane
from app.views.components.widgets import button, keep_place
from engine import EscapeMap, Evidence, Fate
from engine.foundations.wording import format_number, format_whole
from engine.propagation.fates import UNRESOLVED
from engine.systems.outcomes import Exit
from plots.layers.table import LAYERS

STOP, CONTINUE = "Stop", "Continue"


class ProgressView:
    """Shows the progress of a map.

    Parameters
    ----------
    on_cancel, on_resume
        Called when the button is pressed while the map is computed, and after it has been stopped.
    on_layer
        Called with the name of a layer that is offered for a map when its button is pressed.
    """

    def __init__(self, on_cancel: Callable[[], None], on_resume: Callable[[], None], on_layer: Callable[[str], None]) -> None:
        offers = {layer.title: partial(on_layer, name) for name, layer in LAYERS.items()}
        self._actions: dict[str, Callable[[], None]] = {STOP: on_cancel, CONTINUE: on_resume, **offers}
        # Time and undecided share at the beginning of the last stage.
        self._last_stage: tuple[float, float] | None = None
        self.bar = pn.indicators.Progress(value=0, sizing_mode="stretch_width", height=3, margin=0, css_classes=["progress"])
        self.text = TextPane("", name="progress", margin=0, css_classes=["status"])
        self.button = button(STOP, self._press, margin=0, styles=keep_place(shown=False), css_classes=["solid", "stop"])

    def layout(self) -> list[pn.viewable.Viewable]:
        """The text and the button that stand in one line."""
        return [self.text, self.button]

    def start(self) -> None:
        """A new map is requested."""
        self._last_stage = None
        self._set(running=True, label=STOP, text="Starting …")

    def show_reviewing(self) -> None:
        """The potential of the link is reviewed before a map is requested."""
        self._set(running=False, label=STOP, text="Reviewing the potential …")

    def show_compiling(self, seconds: float) -> None:
        """The kernels of the map are compiled first, which takes about this long."""
        left = f"about {math.ceil(seconds)} s left" if seconds > 0.0 else "a moment more"
        self.text.object = f"Compiling the integrator, once for each kind of potential: {left}"

    def show(self, frame: EscapeMap) -> None:
        """Show how far a frame is, and the shares of a complete map."""
        text = with_terms(_result(frame)) if frame.complete else f"{_stage(frame)}{self._time_left(frame)}"
        offered = [layer.title for layer in LAYERS.values() if layer.is_offered(frame)]
        self._set(running=not frame.complete, label=next(iter(offered), STOP), text=text)
        # The text beside an offer is long.
        self.button.css_classes = ["solid", "offer" if offered else "stop"]
        self.button.styles = keep_place(shown=bool(offered) or not frame.complete)
        self.bar.value = int(100 * frame.progress)

    def stop(self) -> None:
        """The map is stopped and can be continued."""
        self._set(running=False, label=CONTINUE, text=f"Stopped: {self.text.object}")
        self.button.styles = keep_place(shown=True)

    def fail(self) -> None:
        """There is no map; the last picture stays."""
        self._set(running=False, label=STOP, text="")

    def _press(self) -> None:
        self._actions[self.button.label]()

    def _time_left(self, frame: EscapeMap) -> str:
        """Estimate from the share of pixels that the last stage, which takes most of the time, has decided so far."""
        now = time.monotonic()
        if frame.horizon < frame.spec.t_max:
            self._last_stage = None
            return ""
        begin, undecided = self._last_stage = self._last_stage or (now, frame.undecided)
        if frame.undecided >= undecided:
            return ""
        left = (now - begin) * frame.undecided / (undecided - frame.undecided)
        return f", about {math.ceil(left)} s left"

    def _set(self, *, running: bool, label: str, text: str) -> None:
        self.bar.styles = {"opacity": "1" if running else "0"}
        self.button.param.update(label=label, styles=keep_place(shown=running))
        self.text.object = text


def _stage(frame: EscapeMap) -> str:
    """Resolution, time reached and undecided share of a frame in progress."""
    resolution = "Full resolution" if frame.stride == 1 else f"1/{frame.stride} of the resolution"
    time = f"t = {format_whole(frame.horizon)} of {format_whole(frame.spec.t_max)}"
    return f"{resolution}, {time}: {percent(frame.undecided)} undecided"


def _result(frame: EscapeMap) -> str:
    """Shares and accuracy of a complete map."""
    shares = frame.fractions()
    part = {fate: percent(share) for fate, share in shares.items()}
    ends = [(fate, end) for fate, end in enumerate(frame.spec.outcomes, 1) if end.occurs]
    # Exits of several channels have longer names.
    exits = [(fate, end.label) for fate, end in ends if end.kind is Exit]
    numbered = [fate for fate, _ in exits] if all(label == f"channel {fate}" for fate, label in exits) else []
    numbers = f"s 1 to {len(numbered)}" if len(numbered) > 1 else " 1"
    parts = [f"channel{numbers}: {', '.join(part[fate] for fate in numbered)}"] if numbered else []
    parts += [f"{escape(end.label)} {part[fate]}" for fate, end in ends if fate not in numbered]
    parts += [f"bounded {part[Fate.BOUNDED]}{_share_on_evidence(frame)}"]
    parts += [f"{UNRESOLVED} {part[Fate.FAILED]}"] if shares[Fate.FAILED] else []
    return (
        f"Done, t = {format_whole(frame.spec.t_max)}. Interior starts: {', '.join(parts)}. "
        f"Energy error ≤ {format_number(frame.worst_energy_error, 2)}.{_rounding(frame)}"
    )


def _rounding(frame: EscapeMap) -> str:
    """A warning of a deep zoom whose pixels double precision does not support."""
    if not frame.is_rounded:
        return ""
    assert frame.rounded_share is not None
    return f" At the limit of double precision: about {percent(frame.rounded_share, 0)} of the pixels depend on rounding errors."


def _share_on_evidence(frame: EscapeMap) -> str:
    """The share of bounded orbits that are called bounded before t_max, in brackets; empty if there are none."""
    evidence = frame.evidence[frame.fate == Fate.BOUNDED]
    early = ~np.isin(evidence, (Evidence.NONE, Evidence.INTEGRATED))
    return f" ({percent(np.mean(early), 0)} of them on evidence)" if early.any() else ""
