"""The section while the visitor changes the energy or the window, which the browser computes and paints over the chart."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import param
from panel.custom import JSComponent

from app.browser.browser_system import slice_name
from app.browser.module_files import LIVE_SECTION_ADDRESS
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.components.widgets import LOADED_MODULE
from engine import Section, Slice, System
from engine.foundations.validation import LARGEST_NUMBER
from plots.pictures.setting import Settings
from plots.studies.section import CELLS, COLOURS, DENSITIES, SECTION_STUDY, density_colours, start_through
from plots.studies.study import Changes


class LiveSection(JSComponent):
    """The module on the page, with the slice of the starts, and energy and window of the chart that the server has sent.

    The browser sends {state, energy} of the point that is clicked.

    Parameters
    ----------
    state
        The view state.
    results
        The results of the session, among them the study of the section.
    change
        Changes the view, under the lock of the session.
    """

    address = param.String(default=LIVE_SECTION_ADDRESS, doc="address of the module")
    slice = param.Dict(default=None, allow_None=True, doc="the slice of the starts; None if the chart has other axes")
    plane = param.String(doc="name of the slice in the tables of windows")
    served = param.Dict(default=None, allow_None=True, doc="energy and window of the server's complete chart; None without one")
    follows_window = param.Boolean(doc="whether the starts are those of the map")
    colouring = param.Dict(default={}, doc="the colours, see `Colouring` in the module of dots")
    duration = param.Number(doc="longest time of the orbits")

    _esm = LOADED_MODULE

    def __init__(self, state: ViewState, results: ShownResults, change: Callable[[Changes], None]) -> None:
        super().__init__(width=0, height=0, margin=0)
        self._state, self._results, self._change = state, results, change
        state.follow(self._show_slice, "section", "system")
        state.follow(self._show_window, "plane", "section")
        state.follow(self._show_colours, "palette", "settings")
        state.follow(lambda t_max: self.param.update(duration=t_max), "t_max")
        results.param.watch(lambda event: self._show_served(), "studies")
        self._show_served()

    def _show_slice(self, section: Section, system: System) -> None:
        plane = section.slice_of_starts
        columns = section.columns_on(plane)
        described = None if columns is None else plane.to_dict(system.potential.units) | {"sectionColumns": columns}
        self.param.update(slice=described, plane=slice_name(plane))

    def _show_window(self, plane: Slice, section: Section) -> None:
        self.follows_window = plane == section.slice_of_starts

    def _show_colours(self, palette: str, settings: Settings) -> None:
        colours = self._state.colours
        self.colouring = {
            "choice": COLOURS.value_in(settings),
            "orbits": list(colours.orbits),
            "inside": colours.bounded,
            "densities": list(DENSITIES),
            "classes": list(density_colours()),
            "cells": CELLS,
        }

    def _show_served(self) -> None:
        found = self._results.studies.get(SECTION_STUDY.name)
        if found is None or not found.complete:
            self.served = None
            return
        (x_low, x_high), (ordinate_low, ordinate_high) = found.spec.find_window().ranges
        window = {"xLow": x_low, "xHigh": x_high, "ordinateLow": ordinate_low, "ordinateHigh": ordinate_high}
        self.served = {"energy": found.spec.common_energy, "window": window}

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"state": [*state], "energy": int() | float() as energy} if _are_numbers(state, 4) and _are_numbers([energy], 1):
                self._change(start_through(self._state.section, self._state.potential, np.array(state, float), float(energy)))


def _are_numbers(values: list[Any], count: int) -> bool:
    """Whether a list contains as many finite numbers of legal size."""
    return len(values) == count and all(isinstance(each, int | float) and abs(each) <= LARGEST_NUMBER for each in values)
