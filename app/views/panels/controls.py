"""The controls of the map: case, energy, plane; and, second to them, t_max, resolution and colours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from html import escape as escape_text
from typing import Any

import panel as pn
import panel_material_ui as pmui

from app.rendering.palette import PALETTES
from app.runtime.load_monitor import process_load_monitor
from app.state.system import SYSTEM, System
from app.state.view_state import RESOLUTION_CHOICES, T_MAX_CHOICES, ViewState
from app.views.components.flex_row import flex_row
from engine import CASES, Plane

OTHER = "other"
"""Stands in the row of cases for every other potential."""

PLAY, STOP = "▶ Play", "■ Stop"
_PLAIN = {"& .MuiToggleButton-root, & .MuiButton-root, & button": {"textTransform": "none", "whiteSpace": "nowrap"}}


@dataclass(frozen=True)
class ControlActions:
    """What the controls do besides setting the state.

    Attributes
    ----------
    look
        A quick look at an energy on the slider's way.
    settle
        The map again where the slider ends.
    play
        A sweep through all energies.
    choose_potential
        Opens the choice among all other potentials.
    """

    look: Callable[[float], None]
    settle: Callable[[], None]
    play: Callable[[], None]
    choose_potential: Callable[[], None]


class ThrottledSlider(pmui.FloatSlider):
    """A slider whose moves are heard sooner than Panel's 50 ms after the first of them, unless the server is behind."""

    @property
    def _debounce(self) -> int:
        return 150 if process_load_monitor().is_high() else 5


class Controls:
    """Widgets that write into the view state and follow it."""

    def __init__(self, state: ViewState, actions: ControlActions) -> None:
        self.state = state
        self._actions = actions
        self._looked = False
        # What a sweep put the slider on: the browser tells it again, sometimes late.
        self._passed: set[float] = set()
        cases = {**{name: name for name in CASES}, "Other …": OTHER}
        self.case = pmui.RadioButtonGroup(label="Case", options=cases, value=self._case(), size="small", sx=_PLAIN)
        self.plane = pmui.RadioButtonGroup(
            label="Plane", options={plane.value: plane for plane in Plane}, value=state.plane, size="small", sx=_PLAIN
        )
        self.energy = ThrottledSlider(label="Energy h", sizing_mode="stretch_width")
        self.play = pmui.Button(label=PLAY, variant="outlined", size="small", width=76, sx=_PLAIN)
        self.exact_energy = pmui.FloatInput(
            label="h exactly", value=state.energy, format="0.[0000000000000000]", width=130, size="small"
        )
        self.t_max = pmui.Select(label="t_max", options=T_MAX_CHOICES, value=state.t_max, width=130, size="small")
        self.resolution = pmui.Select(
            label="Resolution", options=RESOLUTION_CHOICES, value=state.resolution, width=140, size="small"
        )
        self.palette = pmui.Select(
            label="Colours",
            options={palette.name: key for key, palette in PALETTES.items()},
            value=state.palette,
            width=170,
            size="small",
        )
        self.facts = pn.pane.HTML(margin=(0, 10))
        self._follow_case()
        self._connect()

    def layout(self) -> pn.viewable.Viewable:
        """Two strips that wrap on narrow screens: what is looked at, and how."""
        energy = pn.Column(self.energy, min_width=300, max_width=620, sizing_mode="stretch_width", margin=(0, 20))
        what = (pn.Column(self.case, min_width=210), pn.Column(self.plane, min_width=230), energy, self.play, self.exact_energy)
        how = (self.t_max, self.resolution, self.palette, self.facts)
        return pn.Column(_strip(*what), _strip(*how), sizing_mode="stretch_width")

    def _connect(self) -> None:
        state = self.state
        self.case.param.watch(lambda event: self._take_case(event.new), "value")
        self.plane.param.watch(lambda event: self._take_plane(event.new), "value")
        self.palette.param.watch(lambda event: state.param.update(palette=event.new), "value")
        self.play.on_click(lambda event: self._actions.play())
        # Of a move and a release that come together, the release counts.
        self.energy.param.watch(self._look, "value", precedence=1)
        self.energy.param.watch(self._take_slid_energy, "value_throttled")
        self.exact_energy.param.watch(self._take_exact_energy, "value")
        self.t_max.param.watch(lambda event: state.param.update(t_max=event.new), "value")
        self.resolution.param.watch(lambda event: state.param.update(resolution=event.new), "value")
        state.param.watch(lambda *events: self._follow_case(), list(SYSTEM))
        state.param.watch(lambda *events: self._follow_energy(), ["energy", "plane"])
        for name in ("plane", "t_max", "resolution", "palette"):
            state.param.watch(lambda event: getattr(self, event.name).param.update(value=event.new), name)

    def show_playing(self, playing: bool) -> None:
        """Name the button after what it does next."""
        self.play.label = STOP if playing else PLAY
        # Somebody who drags stops at a step.
        self._passed = {energy for energy in self._passed if energy != round(energy, self.state.system.energies.decimals)}

    def show_passing(self, energy: float) -> None:
        """Put the slider where a sweep is."""
        self._passed.add(energy)
        self.energy.value = energy

    def _look(self, event: Any) -> None:
        """The slider is on its way: unless it follows the state or a sweep, somebody drags it."""
        if event.new == self._on_slider():
            self._settle()
        elif event.new not in self._passed:
            self._looked = True
            self._actions.look(event.new)

    def _settle(self) -> None:
        """Back where it was before the quick looks: their picture makes room for the map."""
        if self._looked:
            self._looked = False
            self._actions.settle()

    def _take_case(self, case: str) -> None:
        # The buttons follow the state, too; then there is nothing to take.
        if case == self._case():
            return
        if case == OTHER:
            # Nothing has been chosen yet.
            self.case.value = self._case()
            self._actions.choose_potential()
        else:
            with pn.io.hold():
                self.state.show_system(System(case))

    def _case(self) -> str:
        """The button of the system in view."""
        return self.state.case if self.state.case in CASES else OTHER

    def _take_plane(self, plane: Plane) -> None:
        if plane != self.state.plane:
            with pn.io.hold():
                self.state.param.update(plane=plane, window=None, starts=(), chosen=0)

    def _take_slid_energy(self, event: Any) -> None:
        # The slider stands at its end for an energy typed beyond it, and passes others in a sweep: no wish to go there.
        if event.new != self._on_slider() and event.new not in self._passed:
            self._looked = False
            # All that follows from it makes one message.
            with pn.io.hold():
                self.state.energy = event.new

    def _on_slider(self) -> float:
        """Where the slider stands for the energy of the state."""
        energies = self.state.system.energies
        return float(min(max(self.state.energy, energies.low), energies.high))

    def _take_exact_energy(self, event: Any) -> None:
        if event.new is not None:
            self.state.energy = event.new

    def _follow_case(self) -> None:
        """The slider's span and marks, and the case in a line: formula, channels, escape energy."""
        state, system, energies = self.state, self.state.system, self.state.system.energies
        self.case.value = self._case()
        escape = state.potential.escape_energy
        marks = [{"value": round(escape, 6), "label": f"escape energy {escape:.4g}"}, *({"value": h} for h in energies.marked)]
        step, decimals = 10.0**-energies.decimals, max(energies.decimals, 0)
        scale = {"start": energies.low, "end": energies.high, "step": step, "format": f"0.{'0' * decimals}"}
        self.energy.param.update(**scale, value=self._on_slider(), marks=marks)
        self.exact_energy.step = step
        ticks = " · ticks on the slider: the energies of Zotos (2014)" if energies.marked else ""
        self.facts.object = (
            f'<div style="font-size:14px"><b>{escape_text(system.title)}</b>: H = ½(px² + py²) + V, '
            f"V = {escape_text(system.formula_shown)} · {state.potential.channels} exit channels above the escape energy "
            f"h = {escape:.6g}{ticks}</div>"
        )
        self._follow_energy()

    def _follow_energy(self) -> None:
        state = self.state
        on_h = state.plane is Plane.X_H
        self.energy.param.update(value=self._on_slider(), disabled=on_h)
        self.energy.label = "Energy h: the ordinate of this plane" if on_h else "Energy h"
        self.exact_energy.param.update(value=state.energy, disabled=on_h)


def _strip(*widgets: pn.viewable.Viewable) -> pn.FlexBox:
    return flex_row(*widgets, align_items="center", gap="6px", sizing_mode="stretch_width")
