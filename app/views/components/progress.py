"""How far the map is: a bar, the stage in words, and the button that stops it or goes on."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import panel as pn
import panel_material_ui as pmui

from app.job_clients.error_messages import as_markdown
from engine import PREVIEW_TIME, Certificate, EscapeMap, Fate

_COMPILING = "The integrator is being compiled, once for each kind of potential; the map follows."


class ProgressView:
    """Shows frames' progress; `on_cancel` and `on_resume` are what the button does."""

    def __init__(self, on_cancel: Callable[[], None], on_resume: Callable[[], None]) -> None:
        self._on_cancel, self._on_resume = on_cancel, on_resume
        self._running = False
        self.bar = pmui.LinearProgress(
            variant="determinate", value=0, sizing_mode="stretch_width", min_width=120, max_width=420, margin=(14, 10)
        )
        self.text = pn.pane.HTML("", margin=(5, 10))
        self.button = pmui.Button(label="Cancel", variant="outlined", size="small", disabled=True, width=110)
        self.problem = pmui.Alert(severity="error", visible=False, sizing_mode="stretch_width")
        self.button.on_click(lambda event: self._press())

    def layout(self) -> pn.viewable.Viewable:
        """The bar, the stage, and room for a sentence about what went wrong."""
        line = pn.Row(self.button, self.bar, sizing_mode="stretch_width")
        return pn.Column(line, self.text, self.problem, sizing_mode="stretch_width")

    def start(self, *, compiling: bool = False) -> None:
        """A new map has been asked for, perhaps before the integrators are there."""
        self._set(running=True, label="Cancel", text=_COMPILING if compiling else "Starting …")
        self.problem.visible = False

    def show(self, frame: EscapeMap) -> None:
        """The stage, the horizon reached and what is still undecided."""
        percent = 100 if frame.complete else min(int(100 * frame.progress), 99)
        if frame.complete:
            fractions = frame.fractions()
            channels = (f"channel {k}: {fractions[k]:.1%}" for k in range(1, frame.spec.potential.channels + 1))
            text = (
                f"Done to t = {frame.spec.t_max:g}. Of the interior starts {', '.join(channels)}, bounded: {fractions[0]:.1%}"
                f"{_certified(frame)}. "
            )
            text += f"Worst energy error {frame.worst_energy_error:.1e}."
        else:
            grain = "every pixel" if frame.stride == 1 else f"one pixel of {frame.stride} × {frame.stride}"
            text = f"{grain}, followed to t = {frame.horizon:g}, {frame.undecided:.1%} still undecided"
        self._set(running=not frame.complete, label="Cancel", text=text)
        self.bar.value = percent

    def look(self) -> None:
        """A quick look at an energy in passing; the same words for all of them, as each message takes its time."""
        self._set(running=False, label="Cancel", text=f"Quick looks, followed to t = {PREVIEW_TIME:g} only")
        self.bar.value = 0

    def stop(self) -> None:
        """The map has been cancelled; it can go on."""
        self._set(running=False, label="Go on", text=f"Stopped: {self.text.object}")
        self.button.disabled = False

    def warn(self, sentence: str) -> None:
        """Something was asked for that cannot be had; the map is none the worse for it."""
        # The alert reads Markdown, and with it HTML.
        self.problem.param.update(object=as_markdown(sentence), visible=True)

    def fail(self, sentence: str) -> None:
        """The map cannot be had; the last good picture stays."""
        self._set(running=False, label="Cancel", text="")
        self.warn(sentence)

    def _press(self) -> None:
        if self._running:
            self._on_cancel()
        else:
            self._on_resume()

    def _set(self, *, running: bool, label: str, text: str) -> None:
        self._running = running
        self.button.param.update(label=label, disabled=not running)
        self.text.object = text


def _certified(frame: EscapeMap) -> str:
    """How many bounded orbits needed not be followed to the end, in brackets; nothing where all were."""
    certificates = frame.certificate[frame.fate == Fate.BOUNDED]
    early = ~np.isin(certificates, (Certificate.NONE, Certificate.INTEGRATED))
    return f" ({np.mean(early):.0%} of them certified, the rest followed)" if early.any() else ""
