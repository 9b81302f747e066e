"""The preview, which the engine in the browser draws from the system and the view, and its animation of the energy."""

from __future__ import annotations

from app.browser.browser_system import make_browser_system
from app.browser.engine_component import BrowserEngine
from app.browser.views import describe_view
from app.job_clients.latest_request import LatestRequest
from app.session.context import SessionContext
from engine import EscapeMap
from engine.jobs.job import Job, Queue


class PreviewPresenter:
    """Sends the view to the engine in the browser, and writes the energy at which an animation ends to the state."""

    def __init__(self, context: SessionContext) -> None:
        self._state = context.state
        self.engine = BrowserEngine(context.locked(self._take_energy))
        self._systems = LatestRequest(context.jobs, self.engine.show_system, lambda sentence: None, context.locked)
        context.results.param.watch(lambda event: self._request_system(event.new), "frame")
        shown = ["system", "plane", "energy", "resolution", "window", "palette"]
        self._state.param.watch(lambda *events: self.show_view(), shown)

    def show_view(self) -> None:
        """Send the view to the browser."""
        self.engine.show_view(describe_view(self._state))

    def play(self) -> None:
        """Play the energy up to its highest value, or stop the animation."""
        state, energies = self._state, self._state.energies
        if self.engine.playing:
            self.engine.stop()
        elif state.plane.energy_axis is None:
            self.engine.play(state.energy, energies.low, energies.high)

    def close(self) -> None:
        """Cancel the request at the end of the session."""
        self._systems.cancel()

    def _take_energy(self, energy: float) -> None:
        self._state.energy = round(energy, self._state.energies.decimals)

    def _request_system(self, frame: EscapeMap | None) -> None:
        """Request the system for the browser once a frame has arrived, because it needs the compiled kernels."""
        state = self._state
        if frame is not None and frame.spec.potential == state.potential:
            arguments = state.potential, state.energies.low, state.energies.high
            self._systems.submit(Job(make_browser_system, arguments, queue=Queue.LONG_CALL))
