"""The controls of the map: system, plane, energy, t_max, resolution, colours and layers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from html import escape as escape_text
from typing import Any

import numpy as np
import panel as pn

from app.browser.inputs.counted_inputs import EnergyBox, EnergySlider
from app.state.system_review import review_catalogue_entry
from app.state.view import allowed_resolutions, allowed_t_max
from app.state.view_state import ViewState
from app.views.components.collapsible_section import Fold
from app.views.components.texts import TextPane, breakable, describe_outcomes
from app.views.components.widgets import SegmentedControl, bind, button, set_value, switch
from app.views.panels.analysis_choice import ComparisonSwitch, LayerSwitches
from app.views.panels.engine_component import BrowserEngine
from engine import CASES, Plane, Slice
from engine.foundations.wording import format_number
from plots.pictures.palette import PALETTES

LOCK_SCALE = "Lock colour scale"
"""Label of the switch for the scale of escape times."""

AXES = "Axes …"
"""Label of the button for other slices."""

# Number of characters that fit on the button for other slices. A longer title is among the facts below the case.
_LONGEST_TITLE = 12
# The slices that have buttons. Other slices are chosen by their axes.
_PLANES = (Plane.X_Y, Plane.X_PX, Plane.X_H)
# Notes below the slider, by the place of the axis h.
_ON_AXIS = {0: "Energy is the horizontal axis here", 1: "Energy is the vertical axis here"}
PLAY = "▶ Play"
"""Label of the button that starts the animation."""

FILM = "● Film"
"""Label of the button that starts the animation and saves a film of it."""

STOP = "■ Stop"
"""Label of the button that stops the animation."""

# Margin of the buttons below the box of the energy.
_BELOW = (8, 10, 0, 10)


class Controls:
    """Widgets that write to the view state and follow it.

    Parameters
    ----------
    state
        The view state.
    engine
        Animates the energy.
    toggle_drawer
        Opens or closes the drawer "potential" or "slice".
    swap_views
        Exchanges the two views of the comparison.
    lock_times
        Locks (True) or unlocks (False) the scale of escape times.
    """

    def __init__(
        self,
        state: ViewState,
        engine: BrowserEngine,
        toggle_drawer: Callable[[str], None],
        swap_views: Callable[[], None],
        lock_times: Callable[[bool], None],
    ) -> None:
        self.state = state
        self._lock_times = lock_times
        self.case = SegmentedControl(
            label="Case",
            options=list(CASES),
            value=self._listed_case(),
            css_classes=["segmented", "half", "choice"],
            margin=(0, 0, 0, 10),
        )
        self.other = button(
            "Other …", partial(toggle_drawer, "potential"), kind="light", css_classes=["half", "choice"], margin=(0, 10, 0, 4)
        )
        self.plane = SegmentedControl(
            label="Plane", options={plane.title: plane for plane in _PLANES}, margin=(8, 0, 8, 10),
            css_classes=["segmented", "narrow", "half", "choice"],
        )  # fmt: skip
        # Panel replaces a value of None by the first option when it makes a widget.
        self.plane.value = self._listed_plane()
        self.axes = button(
            AXES, lambda: toggle_drawer("slice"), kind="light", css_classes=["half", "choice"], margin=(8, 10, 8, 4)
        )
        self.energy = EnergySlider(name="energy", sizing_mode="stretch_width", margin=(0, 10), css_classes=["energy"])
        self.play = button(PLAY, engine.play, min_width=84, css_classes=["half", "play-energy"], margin=_BELOW, align="end")
        self.film = button(FILM, engine.film, css_classes=["half", "film-energy"], margin=_BELOW, align="end")
        self.exact_energy = EnergyBox(sizing_mode="stretch_width", css_classes=["half", "exact-energy"], margin=(0, 10))
        self.facts = TextPane(margin=(6, 10), sizing_mode="stretch_width", css_classes=["facts"])
        self.layers = LayerSwitches(state)
        self.comparison = ComparisonSwitch(state, swap_views)
        layer_fold = Fold("Layers", lambda: [*self.layers.parts(), *self.comparison.parts()], is_open=True)
        state.param.watch(lambda *events: layer_fold.rebuild(), ["layers", "compared"])
        self._folds = [Fold("Quality and colours", self._build_quality), layer_fold]
        engine.param.watch(lambda event: self.play.param.update(label=STOP if event.new else PLAY), "playing")
        engine.param.watch(lambda event: self.film.param.update(disabled=event.new), "playing")
        self._follow_system()
        self._connect()

    def layout(self) -> list[pn.viewable.Viewable]:
        """Return the parts of a column: system, plane, exact energy, quality and layers. The energy slider is elsewhere."""
        system = [self.case, self.other, self.facts, self.plane, self.axes]
        energy = [self.exact_energy, self.play, self.film]
        return [*system, *energy, *(part for fold in self._folds for part in fold.parts())]

    def _begin_touch(self) -> None:
        """Adapt to touch input: close the sections, to leave more room for the maps."""
        for fold in self._folds:
            fold.set_open(False)

    def _build_quality(self) -> list[pn.viewable.Viewable]:
        """Make the lists of t_max, resolution and colours, and the switch for the scale of escape times."""
        is_locked = lambda times: times is not None  # noqa: E731
        return [
            self._make_list("t_max", "t_max", allowed_t_max()),
            self._make_list("resolution", "Resolution", allowed_resolutions()),
            self._make_list("palette", "Colours", {palette.name: key for key, palette in PALETTES.items()}),
            switch("Escape times", LOCK_SCALE, self.state, "lock_times", is_locked, self._lock_times, margin=(0, 10)),
        ]

    def _make_list(self, name: str, label: str, options: dict[str, Any]) -> pn.viewable.Viewable:
        """Return a drop-down list for an attribute of the view state."""
        box = pn.widgets.Select(label=label, options=options, sizing_mode="stretch_width", margin=(0, 10, 8, 10))
        return bind(box, self.state, name)

    def _connect(self) -> None:
        state = self.state
        self.case.param.watch(lambda event: self._take_case(event.new), "value")
        self.plane.param.watch(lambda event: self._take_plane(event.new), "value")
        state.param.watch(lambda *events: self._follow_system(), "system")
        state.param.watch(lambda *events: self._follow_energy(), ["energy", "plane"])
        state.param.watch(lambda event: self._follow_plane(), "plane")
        state.param.watch(lambda event: self._begin_touch(), "touch")

    def _take_case(self, case: str | None) -> None:
        # With None, or with the case of the state, the widget only follows the state.
        if case is not None and case != self.state.system.case:
            with pn.io.hold():
                self.state.show_system(review_catalogue_entry(case))

    def _listed_case(self) -> str | None:
        """Return the case of the system in view; None for other potentials."""
        return self.state.system.case if self.state.system.case in CASES else None

    def _follow_plane(self) -> None:
        set_value(self.plane, self._listed_plane())
        title = f"{self.state.plane.title} …"
        is_other = self.plane.value is None
        self.axes.label = title if is_other and len(title) <= _LONGEST_TITLE else AXES
        self._describe(escape_text(self.state.plane.title) if is_other and self.axes.label == AXES else "")

    def _listed_plane(self) -> Slice | None:
        """Return the slice in view if it has a button; None for other slices."""
        plane: Slice = self.state.plane
        return next((each for each in _PLANES if each == plane), None)

    def _take_plane(self, plane: Plane | None) -> None:
        # With None, the widget only follows the state.
        if plane is not None and plane != self.state.plane:
            with pn.io.hold():
                self.state.show_slice(plane)

    def _follow_system(self) -> None:
        """Show the case, the energies and the facts of the system."""
        state, energies = self.state, self.state.energies
        self.case.value = self._listed_case()
        self.other.color = "light" if self._listed_case() else "primary"
        openings = np.sort(state.potential.well.saddle_energies).tolist()
        marks = {"openings": openings, "marked": list(energies.marked), "legend": _openings_legend(openings)}
        self.energy.param.update(low=energies.low, high=energies.high, decimals=energies.decimals, **marks)
        self.exact_energy.step = 10.0**-energies.decimals
        self._follow_plane()
        self._follow_energy()

    def _describe(self, slice_title: str) -> None:
        """Write the formula, the outcomes, and the title of the slice (HTML); the title is empty if a button has it."""
        reviewed = self.state.reviewed
        formula, _, _ = reviewed.formula.partition(";")
        mass, rotation = reviewed.potential.mass, reviewed.potential.rotation
        rotation_text = f"rotates at Ω = {format_number(rotation, 6)}; " if rotation else ""
        masses = [] if mass == 1.0 else [f"Masses {format_number(mass)}: H = (px² + py²)/{format_number(2.0 * mass)} + V"]
        facts = "<br>".join(["", *masses, *([f"Slice {slice_title}"] if slice_title else [])])
        self.facts.object = (
            f"<div title='H = (px² + py²)/2m + V(x, y)'><b>{escape_text(reviewed.system.title)}</b>: "
            f"<span class='quiet'>{rotation_text}{escape_text(describe_outcomes(reviewed))}</span><br>"
            f"{escape_text(breakable(f'V = {formula}'))}<span class='quiet'>{facts}</span></div>"
        )

    def _follow_energy(self) -> None:
        state = self.state
        is_energy_axis = state.plane.energy_axis is not None
        is_below, is_above = state.energy < state.energies.low, state.energy > state.energies.high
        place = "below" if is_below else "above" if is_above else ""
        notes = [f"h = {format_number(state.energy, 12)}, {place} the slider"] if place else []
        if state.potential.rotation:
            notes.append(f"C = {format_number(state.potential.jacobi_constant(state.energy), 9)}, the Jacobi constant")
        note = "; ".join(notes)
        self.energy.param.update(disabled=is_energy_axis, note=_ON_AXIS[state.plane.energy_axis] if is_energy_axis else note)
        self.exact_energy.disabled = self.play.disabled = self.film.disabled = is_energy_axis


def _openings_legend(openings: Sequence[float]) -> str:
    """Return the text about the energies at which exits open; empty without exits over saddles."""
    texts = dict.fromkeys(format_number(energy) for energy in openings)
    return f"┊ exits open at h = {', '.join(texts)}" if texts else ""
