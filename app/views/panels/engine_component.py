"""The engine in the visitor's browser: previews while the energy or the window changes, and the orbit under the cursor."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

import param

from app.browser.module_files import ADDRESS
from app.job_clients.latest_request import LatestRequest, Locked
from app.job_clients.parameter_shares import SHARES_HORIZON, stack_colours
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.components.view_store import ViewStore
from engine import Window
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job, Queue
from plots.browser.browser_system import (
    BrowserSystem,
    describe_slice,
    is_system_compiled,
    make_browser_system,
    slice_name,
    system_key,
    window_in_browser,
)
from plots.browser.javascript import component_code
from plots.layers.map_images import LAYER_COLUMNS
from plots.pictures.image_columns import pixel_coding


class BrowserEngine(ViewStore):
    """An invisible component that runs the engine in the browser, and sends {playing} when an animation of the energy has ended.

    It is also the store of energy and window, because each component adds a dozen elements to the page.

    Parameters
    ----------
    state
        View state, which the engine follows.
    results
        The results of the session. The frame of a map follows the compilation of the kernels.
    jobs, locked
        See `LatestRequest`.
    on_zoom, on_rest
        See `ViewStore`.
    on_pixels
        Called when the pictures rest, with the number of pixels along a side of the largest map on the screen, and with 0 when a
        gesture begins.
    """

    address = param.String(default=ADDRESS, doc="address of the first module")
    system = param.Dict(default={}, doc="see `BrowserSystem.to_dict`")
    view = param.Dict(default={}, doc="see `describe_view`")
    command = param.Dict(default={}, doc="name: play, film or stop; low, high, decimals; number that makes repeats differ")
    playing = param.Boolean(default=False, doc="whether an animation of the energy is running")

    _esm = component_code(Path(__file__).with_suffix(".js"))

    def __init__(
        self,
        state: ViewState,
        results: ShownResults,
        jobs: JobSubmitter,
        locked: Locked,
        on_zoom: Callable[[Window | None], None],
        on_rest: Callable[[], None],
        on_pixels: Callable[[int], None],
    ) -> None:
        super().__init__(state, locked, on_zoom, on_rest)
        self._command_numbers = count()
        self._take_pixels = locked(on_pixels)
        self._end_animation = locked(lambda: self.param.update(playing=False))
        self._system_request = LatestRequest(jobs, self._show_system, lambda sentence: None, locked)
        self._results = results
        results.param.watch(lambda event: self._request_system(), "frame")
        shown_fields = ["system", "plane", "section", "energy", "resolution", "window", "palette"]
        state.param.watch(lambda *events: self.show_view(), shown_fields)

    def show_view(self) -> None:
        """Send the view to the browser, and request its system."""
        self.view = describe_view(self._state)
        self._request_system()

    def play(self) -> None:
        """Animate the energy up to its highest value; from there, begin at the lowest. Stop a running animation."""
        self._animate("play")

    def film(self) -> None:
        """Do the same as `play`, and let the browser save a film of it."""
        self._animate("film")

    def _animate(self, name: str) -> None:
        if self.playing:
            self.stop()
        elif self._state.plane.energy_axis is None:
            self.playing = True
            self._send_command(name)

    def stop(self) -> None:
        """Stop the animation at the current energy."""
        if self.playing:
            self._send_command("stop")

    def _send_command(self, name: str) -> None:
        energies, number = self._state.energies, next(self._command_numbers)
        limits = {"low": energies.low, "high": energies.high, "decimals": energies.decimals}
        self.command = {"name": name, **limits, "number": number}

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"playing": False}:
                self._end_animation()
            case {"pixels": int(pixels)}:
                self._take_pixels(pixels)
            case _:
                super()._handle_msg(message)

    def _request_system(self) -> None:
        """Request the system for the browser, at once if it is compiled in advance.

        Otherwise its compilation would delay the map, so it is requested when the first frame has arrived.
        """
        state, frame = self._state, self._results.frame
        system = state.potential, state.energies.low, state.energies.high, state.section
        has_frame = frame is not None and (frame.spec.potential, frame.spec.section) == (state.potential, state.section)
        if has_frame or is_system_compiled(*system):
            self._system_request.submit(Job(make_browser_system, system, queue=Queue.LONG_CALL))

    def _show_system(self, system: BrowserSystem) -> None:
        self.system = system.to_dict()


def describe_view(state: ViewState) -> dict[str, Any]:
    """Return the view of a state in the form of `ServerView` in app/browser/modules/gestures/preview.js."""
    outcomes = state.potential.outcomes_at(state.energy)
    colours = [entry.colour for entry in state.colours.end_entries(outcomes)]
    return {
        "system": system_key(state.potential, state.section),
        "well": system_key(state.potential),
        "plane": slice_name(state.plane),
        # Only the server knows the potentials along a parameter.
        "slice": describe_slice(state.plane, state.potential, state.section) if state.plane.parameter is None else None,
        "window": None if state.window is None else window_in_browser(state.window),
        "resolution": state.resolution,
        "energies": [state.energies.low, state.energies.high],
        "colours": colours,
        "stack": stack_colours(state.colours, outcomes),
        "sharesHorizon": SHARES_HORIZON,
        "labels": [end.label for end in outcomes],
        "coding": {**pixel_coding(outcomes, state.section), "layers": list(LAYER_COLUMNS)},
    }
