"""Comparison of the map in view with another view, which is computed for the same pixels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from app.job_clients.latest_request import LatestRequest
from app.job_clients.map_requests import jobs_of_map
from app.session.context import SessionContext
from app.state.system_review import PageReview, review_job
from app.state.view import View
from app.views.maps.map_plots import MapsView
from engine import EscapeMap, Fate, MapSpec
from engine.foundations.wording import format_share, format_whole


class ComparisonPresenter:
    """Requests and shows the map of the other view, `ViewState.compared`, and describes the differences.

    Parameters
    ----------
    context
        The session.
    maps
        Shows the other map.
    say
        Shows a text about the two views.
    refuse
        Says why the other view cannot be shown; the comparison ends.
    """

    def __init__(
        self,
        context: SessionContext,
        maps: MapsView,
        say: Callable[[str], None],
        refuse: Callable[[str], None],
    ) -> None:
        self._state, self._maps, self._say, self._refuse = context.state, maps, say, refuse
        self._open_view = context.open_view
        self._map: EscapeMap | None = None
        self._other_map: EscapeMap | None = None
        self._other_review: PageReview | None = None
        self._review_request = LatestRequest(context.jobs, self._take_review, self._refuse_system, context.locked)
        self._map_request = LatestRequest(context.jobs, self._show, self._fail, context.locked)
        self._state.param.watch(lambda event: self._restart(), "compared")
        context.results.param.watch(lambda event: self._follow_map(context.results.whole_map), "frame")
        self._request_missing()

    def swap_views(self) -> None:
        """Exchange the view of the controls and the other view."""
        state, other = self._state, self._state.compared
        if other is None:
            return
        energy = {} if other.energy is None else {"energy": other.energy}
        self._open_view(other.system, {"plane": other.plane, **energy, "window": state.window, "compared": state.view})

    def _follow_map(self, frame: EscapeMap | None) -> None:
        """Compare a complete map. It stays in the comparison until the next map is complete."""
        if frame is not None:
            self._map = frame
            self._request_missing()
            self._describe()

    def _restart(self) -> None:
        self._other_map = None
        self._maps.show_compared(None)
        self._say("")
        self._review_request.cancel()
        self._map_request.cancel()
        self._request_missing()

    def _request_missing(self) -> None:
        """Request the next missing result: the review of the other system, or its map. A refused system ends the comparison."""
        view, reviewed = self._state.compared, self._other_review
        if view is None:
            return
        if reviewed is None or reviewed.system != view.system:
            self._review_request.submit(review_job(view.system))
        elif reviewed.problem is not None:
            self._refuse_system(reviewed.problem)
        elif self._map is not None:
            self._request_map(view, reviewed, self._map.spec)

    def _request_map(self, view: View, reviewed: PageReview, shown_spec: MapSpec) -> None:
        """Request the map of the other view, with the pixels and t_max of the map in view."""
        try:
            window = shown_spec.find_window()
            spec = replace(view.map_spec(reviewed), resolution=shown_spec.resolution, window=window, t_max=shown_spec.t_max)
        except ValueError as error:
            self._fail(str(error))
        else:
            self._map_request.submit(*jobs_of_map(spec))

    def _take_review(self, reviewed: PageReview) -> None:
        self._other_review = reviewed
        self._request_missing()

    def _refuse_system(self, problem: str) -> None:
        """End the comparison with a view whose system is refused."""
        self._state.compared = None
        self._refuse(problem)

    def _fail(self, sentence: str) -> None:
        self._say(f"There is no other view to compare with: {sentence}")

    def _show(self, other: EscapeMap) -> None:
        view = self._state.compared
        assert view is not None, "the request is cancelled together with the comparison"
        self._other_map = other
        self._maps.show_compared(other, view.title)
        self._describe()

    def _describe(self) -> None:
        view, frame, other = self._state.compared, self._map, self._other_map
        if view is not None and frame is not None and other is not None:
            self._say(f"Compared with {view.title}: {_difference(frame, other)}")


def _difference(one: EscapeMap, other: EscapeMap) -> str:
    """Describe how many starts of two maps have different outcomes; "…" until both maps show the same pixels."""
    if not other.complete:
        return "…"
    if one.spec.plane.axis_symbols != other.spec.plane.axis_symbols:
        return "it has different axes, so pixels cannot be compared."
    if one.fate.shape != other.fate.shape or one.spec.find_window() != other.spec.find_window():
        return "…"
    # Pixels of lower fates have no orbit or no outcome.
    counted = (one.fate >= Fate.BOUNDED) & (other.fate >= Fate.BOUNDED)
    if not counted.any():
        return "no start in the window has an orbit in both."
    differ = counted & (one.fate != other.fate)
    counts = " of ".join(format_whole(int(np.count_nonzero(pixels))) for pixels in (differ, counted))
    return f"{counts} starts have different outcomes ({format_share(float(np.mean(differ[counted])))})."
