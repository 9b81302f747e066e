"""The orbits of the starts in the view state: they are requested, drawn, marked on the maps, described, and played."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import panel as pn
from param.parameterized import Event

from app.browser.components.orbit_components import OrbitPlayer
from app.job_clients.chosen_orbit_requests import NeighbourRequests, PeriodicOrbitRequests, SeparationRequests
from app.job_clients.orbit_requests import OrbitRequests, StartOrbit
from app.session.context import SessionContext
from app.views.maps.markers import NO_POINTS, Markers
from app.views.maps.well import WellView
from app.views.orbits.inspector import Inspector
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.path_picture import path_picture
from app.views.orbits.separation_plot import SeparationPlot
from engine import Orbit, Section, Slice
from plots.links.map_view import Start
from plots.pictures.orbit_curves import OrbitCurves, restrict_curves

ORBITS_REMOVED = "Orbits without a start on this slice are left out. The Back button of the browser shows them again."
"""Message after a change of the slice to one on which not all orbits have a place."""

Interval = tuple[float, float]
"""Start and end of a time interval, dimensionless."""


class OrbitPresenter:
    """Requests the orbits of the starts, and passes them to the views of one session.

    Parameters
    ----------
    context
        The session.
    marks
        Draws the starts and sections of the orbits on the maps.
    well
        Draws the paths of the orbits in (x, y).
    add_start
        Adds a typed start, given by x and ordinate.
    """

    def __init__(
        self,
        context: SessionContext,
        marks: Markers,
        well: WellView,
        add_start: Callable[[float, float], None],
    ) -> None:
        state, jobs, locked, latest = context.state, context.jobs, context.locked, context.latest
        self._state, self._results, self._marks, self._well = state, context.results, marks, well
        self._open_view, self._notice = context.open_view, context.notice
        # On a touch screen, the start that was added last, until a message about its orbit is shown.
        self._added_start: Start | None = None
        self._orbits: tuple[StartOrbit, ...] = ()
        # The interval of time in view, None for the whole duration, and the curves restricted to the interval.
        self._interval: Interval | None = None
        self._restricted_curves: list[OrbitCurves | None] = []
        # What the pictures show: the starts with their curves, the index of the chosen start, and the palette.
        self._picture_content: Any = None
        self._draw_restricted_later = locked(self._draw_restricted)
        actions = OrbitActions(
            add=locked(add_start),
            add_neighbour=self._add_neighbour,
            find_periodic_orbit=lambda: self._periodic_orbit_requests.search(),
            open_section=self._open_section,
            show_all_times=lambda: self._set_interval(None),
            copy=context.copy,
        )
        self.controls: OrbitControls = OrbitControls(state, actions)
        self.plots: OrbitPlots = OrbitPlots(state, locked(self._set_interval))
        # Under load the server skips times, to keep up with the player.
        self.player = OrbitPlayer(latest(self._set_time), sizing_mode="stretch_width", margin=(4, 10), css_classes=["player"])
        self._separation_plot: SeparationPlot = SeparationPlot(state)
        self.inspector = Inspector(self.controls, self.player, self.plots, self._separation_plot, latest)
        self._orbit_requests = OrbitRequests(state, jobs, self._show, self.controls.say, latest)
        self._neighbour: Start | None = None
        self._neighbour_requests = NeighbourRequests(state, jobs, self._show_neighbour, locked)
        self._periodic_orbit_requests = PeriodicOrbitRequests(
            state, jobs, self.controls.say, locked, context.change, self._orbit_requests.name_periodic
        )
        self._separation_requests = SeparationRequests(state, jobs, self._separation_plot.show, self.controls.say, locked)
        state.param.watch(self._update_message, ["starts", "chosen", "system", "plane", "section", "energy", "t_max"])
        state.param.watch(lambda *events: self._show(self._orbits), ["chosen", "palette"])
        state.param.watch(self._record_added_start, "starts")

    def begin(self) -> None:
        """Request the orbits of the first view state."""
        self._update_message()
        self._orbit_requests.follow()

    def _record_added_start(self, event: Event) -> None:
        """Record a start that is added on a touch screen, for `_announce_added_start`."""
        added = [start for start in event.new if start not in event.old]
        self._added_start = added[0] if len(added) == 1 and self._state.touch else None

    def _announce_added_start(self, orbits: Sequence[StartOrbit]) -> None:
        """Show verdict and path of the added start in a message, because on a phone the panel and the path are out of view."""
        for slot, orbit in enumerate(orbits):
            if orbit.start == self._added_start and orbit.curves is not None:
                self._added_start = None
                colour = self._state.colours.path_colour(orbit.curves.orbit.fate, orbit.curves.orbit.outcomes, slot)
                self._notice.show_picture(orbit.headline(), path_picture(orbit.curves, colour))

    def _update_message(self, *events: Event) -> None:
        """Show the hint without orbits, or that a change of the plane has left out orbits; clear other messages."""
        self.controls.end_message(has_orbits=bool(self._state.starts))
        changed = {event.name: event for event in events}
        starts = changed.get("starts")
        if starts is not None and len(starts.new) < len(starts.old):
            # A picture may show an orbit that is left out.
            self._notice.clear()
            if "plane" in changed:
                self._notice.show(ORBITS_REMOVED)

    def _show_neighbour(self, sentence: str, neighbour: Start | None) -> None:
        self._neighbour = neighbour
        self.controls.show_neighbour(sentence, is_known=neighbour is not None)

    def _add_neighbour(self) -> None:
        if self._neighbour is not None and not self._state.add_start(self._neighbour):
            self.controls.say("Remove an orbit to add another.")

    def _open_section(self) -> None:
        """Open the Poincaré section of the system of the chosen orbit, at the energy of the orbit."""
        state, start = self._state, self._state.chosen_start
        if start is None:
            return
        orbit = self._orbits[state.chosen].orbit if state.chosen < len(self._orbits) else None
        plane, starts = _open_on(state.section, orbit)
        energy = float(state.plane.energies(state.energy, *start))
        self._open_view(
            state.plane.system_at(state.system, *start),
            {"plane": plane, "energy": energy, "window": None, "starts": starts, "chosen": 0},
        )

    def _show(self, orbits: Sequence[StartOrbit]) -> None:
        """Show the orbits. Update only the texts if only Birkhoff digits are new."""
        state = self._state
        if [orbit.curves for orbit in orbits] != [orbit.curves for orbit in self._orbits]:
            self._interval, self._restricted_curves = None, []
        self._orbits = tuple(orbits)
        state.known_orbits = {orbit.start: orbit.curves for orbit in orbits if orbit.curves is not None}
        # The chosen index is already that of a longer list of starts, whose orbits follow soon.
        if state.chosen >= len(orbits) and orbits:
            return
        content = [(orbit.start, orbit.curves) for orbit in orbits], state.chosen, state.palette
        with pn.io.hold():
            if content != self._picture_content:
                self._picture_content = content
                self._mark()
                self._draw()
                self._separation_requests.follow(orbits)
                self._neighbour_requests.follow(orbits)
            self._show_texts()
            self._announce_added_start(orbits)
            # The inspector adds its panes last: a text that changes before it is in the document gets links to stylesheets of
            # another host. Orbits that are still being integrated count, because removing the plots and adding them again takes
            # four times as long as an integration.
            self.inspector.follow(len(orbits), sum(not orbit.problem for orbit in orbits))

    def _mark(self) -> None:
        """Mark starts and sections on the maps."""
        self._marks.show_starts([orbit.start for orbit in self._orbits])
        on_section = self._state.section.is_drawn_on(self._state.plane)
        all_curves = [orbit.curves for orbit in self._orbits]
        self._marks.show_sections([curves.section if curves is not None and on_section else NO_POINTS for curves in all_curves])

    def _draw(self) -> None:
        """Draw the orbits in the interval of time in view."""
        all_curves = [orbit.curves for orbit in self._orbits] if self._interval is None else self._restricted_curves
        chosen = self._state.chosen
        chosen_curves = all_curves[chosen] if all_curves else None
        duration = (0.0, float(chosen_curves.orbit.t[-1])) if chosen_curves is not None else None
        self._well.show_orbits(all_curves, chosen)
        self.plots.show(all_curves, chosen, self._interval)
        self.player.follow(self._interval or duration)
        self.controls.show_interval(self._interval, duration[1] if duration is not None else 0.0)

    def _set_time(self, t: float | None) -> None:
        """Mark a time on the paths and the histories."""
        self._well.set_time(t)
        self.plots.set_time(t)

    def _show_texts(self) -> None:
        """Show the results of the orbits as text."""
        orbit = self._orbits[self._state.chosen] if self._orbits else None
        self.controls.show(self._orbits, self._state.chosen)
        verdict = orbit.verdict if orbit is not None else None
        self.controls.show_indicators(verdict.findings if verdict is not None else ())
        self._results.orbits = self._orbits

    def _set_interval(self, interval: Interval | None) -> None:
        """Restrict the curves to an interval of time; None shows the whole duration."""
        all_curves = [orbit.curves for orbit in self._orbits]
        if interval is None:
            self._draw_restricted(all_curves, None, [])
        else:
            # Restricting the curves of a long orbit takes up to a second, so it runs in a thread.
            pn.state.execute(partial(self._restrict_in_thread, all_curves, interval))

    async def _restrict_in_thread(self, all_curves: list[OrbitCurves | None], interval: Interval) -> None:
        restricted = await asyncio.to_thread(_restrict_all, all_curves, interval)
        self._draw_restricted_later(all_curves, interval, restricted)

    def _draw_restricted(
        self, all_curves: list[OrbitCurves | None], interval: Interval | None, restricted: list[OrbitCurves | None]
    ) -> None:
        """Draw restricted curves, unless the orbits have changed in the meantime."""
        if all_curves == [orbit.curves for orbit in self._orbits]:
            self._interval, self._restricted_curves = interval, restricted
            with pn.io.hold():
                self._draw()


def _restrict_all(all_curves: Sequence[OrbitCurves | None], interval: Interval) -> list[OrbitCurves | None]:
    return [restrict_curves(curves, *interval) if curves is not None else None for curves in all_curves]


def _open_on(section: Section, orbit: Orbit | None) -> tuple[Slice, tuple[Start, ...]]:
    """Return the slice on a section that shows an orbit, and the start of the orbit on it, if there is one."""
    found = None
    if orbit is not None and orbit.potential is not None:
        found = section.find_start(orbit.potential, np.array([orbit.x[0], orbit.y[0], orbit.px[0], orbit.py[0]]))
    return (section.slice_of_starts, ()) if found is None else (found[0], (found[1],))
