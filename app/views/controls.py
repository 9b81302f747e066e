"""The controls of the map: case, energy, plane; and, second to them, t_max and resolution."""

from __future__ import annotations

from typing import Any

import panel as pn
import panel_material_ui as pmui

from app.paper_energies import ENERGIES
from app.view_state import RESOLUTION_CHOICES, T_MAX_CHOICES, ViewState
from engine import CASES, Plane

_FORMULAS = {
    "I": "V = ½(x² + y²) − x y²",
    "II": "V = ½(x² + y²) − x(x²/3 − y²)",
    "III": "V = ½(x² + y²) − x² y²",
}
_ENERGY_STEP = 0.001
_PLAIN = {"& .MuiToggleButton-root, & .MuiButton-root, & button": {"textTransform": "none", "whiteSpace": "nowrap"}}
_ONE_LINE = {"& .MuiFormControlLabel-label": {"whiteSpace": "nowrap"}}


class Controls:
    """Widgets that write into the view state and follow it."""

    def __init__(self, state: ViewState) -> None:
        self.state = state
        self.case = pmui.RadioButtonGroup(label="Case", options=list(CASES), value=state.case, size="small", sx=_PLAIN)
        self.plane = pmui.RadioButtonGroup(
            label="Plane", options={plane.value: plane for plane in Plane}, value=state.plane, size="small", sx=_PLAIN
        )
        self.energy = pmui.FloatSlider(label="Energy h", step=_ENERGY_STEP, format="0.000", sizing_mode="stretch_width")
        self.exact_energy = pmui.FloatInput(
            label="h exactly", value=state.energy, step=_ENERGY_STEP, format="0.[0000000000000000]", width=130, size="small"
        )
        self.t_max = pmui.Select(label="t_max", options=T_MAX_CHOICES, value=state.t_max, width=130, size="small")
        self.resolution = pmui.Select(
            label="Resolution", options=RESOLUTION_CHOICES, value=state.resolution, width=140, size="small"
        )
        self.judge = pmui.Switch(label="Regular or chaotic", value=state.judge, width=190, sx=_ONE_LINE)
        self.facts = pn.pane.HTML(margin=(0, 10))
        self._follow_case()
        self._connect()

    def layout(self) -> pn.viewable.Viewable:
        """A strip that wraps on narrow screens."""
        energy = pn.Column(self.energy, min_width=300, max_width=430, sizing_mode="stretch_width", margin=(0, 20))
        choices = pn.Column(self.case, min_width=150), pn.Column(self.plane, min_width=230)
        strip = pn.FlexBox(
            *choices,
            energy,
            self.exact_energy,
            self.t_max,
            self.resolution,
            self.judge,
            align_items="center",
            gap="6px",
            sizing_mode="stretch_width",
        )
        return pn.Column(strip, self.facts, sizing_mode="stretch_width")

    def _connect(self) -> None:
        state = self.state
        self.case.param.watch(
            lambda event: state.param.update(case=event.new, energy=ENERGIES[event.new].first, window=None, start=None), "value"
        )
        self.plane.param.watch(lambda event: state.param.update(plane=event.new, window=None, start=None), "value")
        self.energy.param.watch(self._take_slid_energy, "value_throttled")
        self.exact_energy.param.watch(self._take_exact_energy, "value")
        self.t_max.param.watch(lambda event: state.param.update(t_max=event.new), "value")
        self.resolution.param.watch(lambda event: state.param.update(resolution=event.new), "value")
        self.judge.param.watch(lambda event: state.param.update(judge=event.new), "value")
        state.param.watch(lambda event: self._follow_case(), "case")
        state.param.watch(lambda event: self._follow_energy(), ["energy", "plane"])

    def _take_slid_energy(self, event: Any) -> None:
        # The slider stands at its end for an energy typed beyond it; that is no wish to go there.
        if event.new != self._on_slider():
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
