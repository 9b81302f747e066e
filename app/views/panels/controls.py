"""The controls of the map: system, plane and energy; t_max, resolution and colours; layers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from html import escape as escape_text
from typing import Any

import panel as pn

from app.runtime.process_state import process_state
from app.state.energy_ranges import EnergyRange
from app.state.system import SYSTEM, review_catalogue_entry
from app.state.view_state import ViewState, allowed_resolutions, allowed_t_max
from app.views.components.analysis_choice import LayerSwitches
from app.views.components.collapsible_section import Fold
from app.views.components.number_box import NumberBox
from app.views.components.widgets import SegmentedControl, Slider, Switches, bind, button
from engine import CASES, Plane
from plots.palette import PALETTES

LOCK = "Lock colour scale"
PLAY, STOP = "▶ Play", "■ Stop"
_MOST_DECIMALS = 12
# Space beside the rail of a slider, half the width of its thumb, see theme.css.
_THUMB = "9px"
_TICK = "position:absolute;left:{share:.2%};width:1px;height:6px;background:var(--ui-edge-strong)"
_TICK_LABEL = (
    "position:absolute;top:7px;left:clamp(0px, calc({share:.2%} - 80px), calc(100% - 160px));width:160px;text-align:center"
)


@dataclass(frozen=True)
class ControlActions:
    """What the controls do apart from changing the state.

    Attributes
    ----------
    preview
        Called with each energy that the slider passes while it is dragged.
    settle
        Called when the slider is dragged back to the energy of the state: the map is shown again.
    play
        Starts or stops the animation over all energies.
    choose_potential
        Opens the choice of other potentials.
    lock_times
        Called with whether the scale of escape times keeps its limits.
    """

    preview: Callable[[float], None]
    settle: Callable[[], None]
    play: Callable[[], None]
    choose_potential: Callable[[], None]
    lock_times: Callable[[bool], None]


class ThrottledSlider(Slider):
    """A slider that reports its moves after 5 ms, in place of Panel's 50 ms, and after 150 ms under high load."""

    @property
    def _debounce(self) -> int:
        return 150 if process_state().load.is_high() else 5


class Controls:
    """Widgets that write to the view state and follow it."""

    def __init__(self, state: ViewState, actions: ControlActions) -> None:
        self.state = state
        self._actions = actions
        self._previewed = False
        self._following = False
        self.case = SegmentedControl(
            label="Case", options=list(CASES), value=self._case(), css_classes=["segmented", "half"], margin=(0, 0, 0, 10)
        )
        self.other = button("Other …", actions.choose_potential, kind="light", css_classes=["half"], margin=(0, 10, 0, 4))
        self.plane = SegmentedControl(
            label="Plane", options={plane.value: plane for plane in Plane}, value=state.plane, margin=(8, 10)
        )
        self.ticks = pn.pane.HTML(sizing_mode="stretch_width", height=24, margin=(0, 10))
        self.play = button(PLAY, actions.play, width=84, css_classes=["half"], margin=(0, 10), align="end")
        self.exact_energy = NumberBox(
            self._take_exact_energy,
            state.energy,
            label="Exact h",
            sizing_mode="stretch_width",
            css_classes=["half"],
            margin=(0, 0, 0, 10),
        )
        self.facts = pn.pane.HTML(margin=(6, 10), sizing_mode="stretch_width")
        self.layers = LayerSwitches(state)
        layers = Fold("Layers", self.layers.parts, is_open=True)
        state.param.watch(lambda event: layers.rebuild(), "manifolds")
        self._folds = [Fold("Quality and colours", self._build_quality), layers]
        self._energy_column = pn.Column(sizing_mode="stretch_width", margin=0, css_classes=["energy"])
        self._follow_system()
        self._connect()

    def layout(self, potential: pn.viewable.Viewable) -> list[pn.viewable.Viewable]:
        """Parts of a column: the system with the choice of other potentials, plane, energy, quality and layers."""
        system = [self.case, self.other, self.facts, potential, self.plane]
        energy = [self._energy_column, self.exact_energy, self.play]
        return [*system, *energy, *(part for fold in self._folds for part in fold.parts())]

    def begin_touch(self) -> None:
        """The page is used by touch: leave more room for the maps."""
        for fold in self._folds:
            fold.open(False)

    def _build_quality(self) -> list[pn.viewable.Viewable]:
        """Make the lists of what costs time, and of the colours."""
        return [
            self._make_list("t_max", "t_max", allowed_t_max()),
            self._make_list("resolution", "Resolution", allowed_resolutions()),
            self._make_list("palette", "Colours", {palette.name: key for key, palette in PALETTES.items()}),
            self._make_lock(),
        ]

    def _make_list(self, name: str, label: str, options: dict[str, Any]) -> pn.viewable.Viewable:
        """A drop-down list of an attribute of the view state."""
        box = pn.widgets.Select(label=label, options=options, sizing_mode="stretch_width", margin=(0, 10, 8, 10))
        return bind(box, self.state, name)

    def _make_lock(self) -> pn.viewable.Viewable:
        """A switch that keeps the limits of the escape times."""
        state, on = self.state, [LOCK]
        lock = Switches(label="Escape times", options=on, value=on if state.lock_times is not None else [], margin=(0, 10))
        lock.param.watch(lambda event: self._take_lock(bool(event.new)), "value")
        state.param.watch(lambda event: lock.param.update(value=on if event.new is not None else []), "lock_times")
        return lock

    def _take_lock(self, locked: bool) -> None:
        if locked != (self.state.lock_times is not None):
            self._actions.lock_times(locked)

    def _connect(self) -> None:
        state = self.state
        self.case.param.watch(lambda event: self._take_case(event.new), "value")
        self.plane.param.watch(lambda event: self._take_plane(event.new), "value")
        state.param.watch(lambda *events: self._follow_system(), list(SYSTEM))
        state.param.watch(lambda *events: self._follow_energy(), ["energy", "plane"])
        state.param.watch(lambda event: self.plane.param.update(value=event.new), "plane")

    def show_playing(self, playing: bool) -> None:
        """Label the button with what it does next."""
        self.play.label = STOP if playing else PLAY

    def show_animated(self, energy: float) -> None:
        """Move the slider to an energy of the animation."""
        self._following = True
        try:
            self.energy.value = energy
        finally:
            self._following = False

    def show_energy(self, energy: float) -> None:
        """Show the energy of a preview as a number."""
        self.exact_energy.show(round(energy, self.state.energies.decimals))

    def _preview(self, event: Any) -> None:
        """The slider moves; a move to the energy of the state is the end of a drag, or follows the state."""
        if self._following:
            return
        energy = _without_noise(event.new)
        if energy == _without_noise(self._slider_energy()):
            self._settle()
        else:
            self._previewed = True
            self._actions.preview(energy)

    def _settle(self) -> None:
        """Show the map again after previews of other energies."""
        if self._previewed:
            self._previewed = False
            self._actions.settle()

    def _take_case(self, case: str | None) -> None:
        # None and the case of the state: the widget follows the state.
        if case is not None and case != self.state.case:
            with pn.io.hold():
                self.state.show_system(review_catalogue_entry(case))

    def _case(self) -> str | None:
        """The case of the system in view; None for other potentials."""
        return self.state.case if self.state.case in CASES else None

    def _take_plane(self, plane: Plane) -> None:
        if plane != self.state.plane:
            with pn.io.hold():
                self.state.param.update(plane=plane, window=None, starts=(), chosen=0)

    def _take_slider_energy(self, event: Any) -> None:
        # An energy beyond the slider, which can be typed, stays when the slider is released at its end.
        energy = _without_noise(event.new)
        if not self._following and energy != _without_noise(self._slider_energy()):
            self._previewed = False
            # All that follows makes one message.
            with pn.io.hold():
                self.state.energy = energy

    def _slider_energy(self) -> float:
        """The position of the slider for the energy of the state."""
        energies = self.state.energies
        return float(min(max(self.state.energy, energies.low), energies.high))

    def _take_exact_energy(self, energy: float) -> None:
        with pn.io.hold():
            self.state.energy = energy

    def _follow_system(self) -> None:
        """Show slider, ticks, formula, channels and escape energy of the system."""
        state, reviewed, energies = self.state, self.state.reviewed, self.state.energies
        self.case.value = self._case()
        self.other.color = "light" if self._case() else "primary"
        self.energy = self._make_slider(energies)
        self.ticks.object = _ticks(state.potential.escape_energy, energies)
        self._energy_column.objects = [self.energy, self.ticks]
        self.exact_energy.step = 10.0**-energies.decimals
        self.facts.object = (
            f"<div title='H = ½(px² + py²) + V(x, y)'><b>{escape_text(reviewed.system.title)}</b>: "
            f"V = {escape_text(reviewed.formula_shown)}<br><span class='quiet'>"
            f"{state.potential.channels} exit channels above h = {state.potential.escape_energy:.6g}</span></div>"
        )
        self._follow_energy()

    def _make_slider(self, energies: EnergyRange) -> ThrottledSlider:
        """A slider for a range of energies; if the range of one changed, Bokeh would report a clamped value as a user's."""
        slider = ThrottledSlider(
            label="Energy h", start=energies.low, end=energies.high, step=10.0**-energies.decimals, value=self._slider_energy(),
            format=_slider_format(self._slider_energy(), energies), sizing_mode="stretch_width", margin=(0, 10),
        )  # fmt: skip
        # If a move and a release arrive together, the release is handled first.
        slider.param.watch(self._preview, "value", precedence=1)
        slider.param.watch(self._take_slider_energy, "value_throttled")
        return slider

    def _follow_energy(self) -> None:
        state = self.state
        on_h = state.plane is Plane.X_H
        energies, shown = state.energies, self._slider_energy()
        label = "Energy h" if shown == state.energy else f"h = {state.energy:.12g}, beyond the end of the slider"
        # The browser uses a new format when the value changes.
        self.energy.format = _slider_format(shown, energies)
        self.energy.param.update(value=shown, disabled=on_h, label="Energy is the vertical axis here" if on_h else label)
        self.exact_energy.disabled = on_h
        self.exact_energy.show(state.energy)
        self.play.disabled = on_h


def _without_noise(energy: float) -> float:
    """An energy without the rounding error of the browser, which sends multiples of the slider's step."""
    return round(energy, _MOST_DECIMALS)


def _slider_format(energy: float, energies: EnergyRange) -> str:
    """Format that shows an energy without rounding, and with the decimals of the steps at least."""
    decimals = max(len(f"{energy:.12f}".rstrip("0").partition(".")[2]), energies.decimals, 0)
    return f"0.{'0' * decimals}"


def _ticks(escape: float, energies: EnergyRange) -> str:
    """HTML of ticks below the slider, at the marked energies and with a label at the escape energy."""
    shares = [(energy - energies.low) / (energies.high - energies.low) for energy in (escape, *energies.marked)]
    ticks = "".join(f"<i style='{_TICK.format(share=share)}'></i>" for share in shares if 0.0 <= share <= 1.0)
    label = (
        f"<span style='{_TICK_LABEL.format(share=shares[0])}'>escape energy {escape:.4g}</span>" if 0 <= shares[0] <= 1 else ""
    )
    style = f"position:relative;height:22px;margin:0 {_THUMB};font-size:12px;color:var(--ui-quiet)"
    return f"<div style='{style}'>{ticks}{label}</div>"
