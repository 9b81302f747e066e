"""The controls of the map: case, energy, plane; and, second to them, t_max, resolution and colours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import panel as pn
import panel_material_ui as pmui

from app.palette import PALETTES
from app.paper_energies import ENERGIES
from app.view_state import RESOLUTION_CHOICES, T_MAX_CHOICES, ViewState
from app.views.wrapping import wrapping_row
from engine import CASES, Plane

_FORMULAS = {
    "I": "V = ½(x² + y²) − x y²",
    "II": "V = ½(x² + y²) − x(x²/3 − y²)",
    "III": "V = ½(x² + y²) − x² y²",
}
PLAY, STOP = "▶ Play", "■ Stop"
ENERGY_DECIMALS = 3
"""Of the energies that the slider stops at."""

_ENERGY_STEP = 10.0**-ENERGY_DECIMALS
_PLAIN = {"& .MuiToggleButton-root, & .MuiButton-root, & button": {"textTransform": "none", "whiteSpace": "nowrap"}}


@dataclass(frozen=True)
class EnergyActions:
    """What the energy slider does besides setting h: quick looks on its way, the map again where it ends, and play."""

    look: Callable[[float], None]
    settle: Callable[[], None]
    play: Callable[[], None]


class PromptSlider(pmui.FloatSlider):
    """A slider whose moves are heard sooner than Panel's 50 ms after the first of them."""

    _debounce = 5


class Controls:
    """Widgets that write into the view state and follow it."""

    def __init__(self, state: ViewState, energy_actions: EnergyActions) -> None:
        self.state = state
        self._energy_actions = energy_actions
        self._looked = False
        # What a sweep put the slider on: the browser tells it again, sometimes late.
        self._passed: set[float] = set()
        self.case = pmui.RadioButtonGroup(label="Case", options=list(CASES), value=state.case, size="small", sx=_PLAIN)
        self.plane = pmui.RadioButtonGroup(
            label="Plane", options={plane.value: plane for plane in Plane}, value=state.plane, size="small", sx=_PLAIN
        )
        self.energy = PromptSlider(label="Energy h", step=_ENERGY_STEP, format="0.000", sizing_mode="stretch_width")
        self.play = pmui.Button(label=PLAY, variant="outlined", size="small", width=76, sx=_PLAIN)
        self.exact_energy = pmui.FloatInput(
            label="h exactly", value=state.energy, step=_ENERGY_STEP, format="0.[0000000000000000]", width=130, size="small"
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
        what = (pn.Column(self.case, min_width=150), pn.Column(self.plane, min_width=230), energy, self.play, self.exact_energy)
        how = (self.t_max, self.resolution, self.palette, self.facts)
        return pn.Column(_strip(*what), _strip(*how), sizing_mode="stretch_width")

    def _connect(self) -> None:
        state = self.state
        self.case.param.watch(lambda event: self._take_case(event.new), "value")
        self.plane.param.watch(lambda event: self._take_plane(event.new), "value")
        self.palette.param.watch(lambda event: state.param.update(palette=event.new), "value")
        self.play.on_click(lambda event: self._energy_actions.play())
        # Of a move and a release that come together, the release counts.
        self.energy.param.watch(self._look, "value", precedence=1)
        self.energy.param.watch(self._take_slid_energy, "value_throttled")
        self.exact_energy.param.watch(self._take_exact_energy, "value")
        self.t_max.param.watch(lambda event: state.param.update(t_max=event.new), "value")
        self.resolution.param.watch(lambda event: state.param.update(resolution=event.new), "value")
        state.param.watch(lambda event: self._follow_case(), "case")
        state.param.watch(lambda *events: self._follow_energy(), ["energy", "plane"])
        for name in ("case", "plane", "t_max", "resolution", "palette"):
            state.param.watch(lambda event: getattr(self, event.name).param.update(value=event.new), name)

    def show_playing(self, playing: bool) -> None:
        """Name the button after what it does next."""
        self.play.label = STOP if playing else PLAY
        # Somebody who drags stops at a step.
        self._passed = {energy for energy in self._passed if energy != round(energy, ENERGY_DECIMALS)}

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
            self._energy_actions.look(event.new)

    def _settle(self) -> None:
        """Back where it was before the quick looks: their picture makes room for the map."""
        if self._looked:
            self._looked = False
            self._energy_actions.settle()

    def _take_case(self, case: str) -> None:
        # The buttons follow the state, too; then there is nothing to take.
        if case != self.state.case:
            self.state.param.update(case=case, energy=ENERGIES[case].first, window=None, starts=(), chosen=0)

    def _take_plane(self, plane: Plane) -> None:
        if plane != self.state.plane:
            self.state.param.update(plane=plane, window=None, starts=(), chosen=0)

    def _take_slid_energy(self, event: Any) -> None:
        # The slider stands at its end for an energy typed beyond it, and passes others in a sweep: no wish to go there.
        if event.new != self._on_slider() and event.new not in self._passed:
            self._looked = False
            self.state.energy = event.new

    def _on_slider(self) -> float:
        """Where the slider stands for the energy of the state."""
        energies = ENERGIES[self.state.case]
        return float(min(max(self.state.energy, energies.low), energies.high))

    def _take_exact_energy(self, event: Any) -> None:
        if event.new is not None:
            self.state.energy = event.new

    def _follow_case(self) -> None:
        """The slider's span and marks, and the case in a line: formula, channels, escape energy."""
        state, energies = self.state, ENERGIES[self.state.case]
        escape = state.potential.escape_energy
        marks = [{"value": round(escape, 6), "label": f"escape energy {escape:.4g}"}, *({"value": h} for h in energies.marked)]
        self.energy.param.update(start=energies.low, end=energies.high, value=state.energy, marks=marks)
        self.facts.object = (
            f'<div style="font-size:14px"><b>Case {state.case}</b>: H = ½(px² + py²) + V, {_FORMULAS[state.case]} · '
            f"{state.potential.channels} exit channels above the escape energy h = {escape:.6g} · "
            "ticks on the slider: the energies of Zotos (2014)</div>"
        )
        self._follow_energy()

    def _follow_energy(self) -> None:
        state = self.state
        on_h = state.plane is Plane.X_H
        self.energy.param.update(value=self._on_slider(), disabled=on_h)
        self.energy.label = "Energy h: the ordinate of this plane" if on_h else "Energy h"
        self.exact_energy.param.update(value=state.energy, disabled=on_h)


def _strip(*widgets: pn.viewable.Viewable) -> pn.FlexBox:
    return wrapping_row(*widgets, align_items="center", gap="6px", sizing_mode="stretch_width")
