"""The page's address: shown at the start and when the browser's history moves, and written when the state changes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any
from urllib.parse import parse_qsl

import panel as pn
from bokeh.document import Document

from app.session.potential_presenter import PotentialPresenter
from app.state.history import History
from app.state.permalink import LINKED, fit_to_system, linked_system, read_link, refused_link, without_system, write_link
from app.state.system_review import SystemReview, is_known, review_catalogue_entry
from app.state.view_state import ViewState
from app.views.components.notice import Notice
from app.views.components.progress import ProgressView
from app.views.maps.map_toolbar import MapToolbar
from app.views.panels.browser_events import BrowserEvents
from engine.service import System


class LinkPresenter:
    """The links of one session, and the view state that the first one describes.

    Parameters
    ----------
    document
        The page.
    parameters
        Those of its address.
    """

    def __init__(self, document: Document, parameters: Mapping[str, str]) -> None:
        self._document = document
        self._link, self._problems = read_link(parameters)
        self._navigating = False
        self.history = History()
        self.state = self._first_state()

    def connect(
        self,
        potential: PotentialPresenter,
        browser: BrowserEvents,
        toolbar: MapToolbar,
        progress: ProgressView,
        notice: Notice,
    ) -> None:
        """Follow the changes of the state, which these parts of the page show."""
        self._potential, self._browser, self._toolbar = potential, browser, toolbar
        self._progress, self._notice = progress, notice
        self.state.param.watch(self._write, list(LINKED))
        self._follow_history()

    def begin(self, begin_view: Callable[[], object]) -> None:
        """Show the view of the first link once its system is reviewed; `begin_view` requests what the state describes."""
        system = linked_system(self._link)
        if is_known(system):
            begin_view()
            self._show_problems()
        else:
            self._review(system, self._begin_with, partial(self._begin_without, begin_view))

    def open(self, system: System, use: Callable[[SystemReview], object]) -> None:
        """Use a system once it is reviewed, or say why it is refused."""
        self._review(system, use, self._refuse)

    def navigate(self, link: str, entry: int, steps: int) -> None:
        """Show the state of a link in the browser's history."""
        self._browser.follow_steps(steps)
        values, _ = read_link(dict(parse_qsl(link.removeprefix("?"))))
        self.history.move_to(entry)
        self.open(linked_system(values), partial(self._show, values))

    def _first_state(self) -> ViewState:
        """The view of the link, with the first system in place of one that must be reviewed."""
        system = linked_system(self._link)
        if not is_known(system):
            return ViewState(**without_system(self._link))
        fitting, problems = fit_to_system(self._link, review_catalogue_entry(system.case))
        self._problems += problems
        return ViewState(case=system.case, **fitting)

    def _begin_with(self, reviewed: SystemReview) -> None:
        """Show the view of the first link with the system that it names."""
        self._problems += self._show(self._link, reviewed)
        self._potential.panel.section.open(True)
        self._show_problems()

    def _begin_without(self, begin_view: Callable[[], object], problem: str) -> None:
        """Show the first view in place of a system that is refused."""
        self._problems.append(refused_link(problem))
        begin_view()
        self._show_problems()

    def _show_problems(self) -> None:
        if self._problems:
            self._notice.warn(" ".join(self._problems))

    def _review(self, system: System, use: Callable[[SystemReview], object], refuse: Callable[[str], None]) -> None:
        """Review a system, and say so meanwhile."""
        if self._potential.open(system, use, refuse):
            self._progress.show_reviewing()

    def _refuse(self, problem: str) -> None:
        self._progress.fail()
        self._notice.warn(refused_link(problem))

    def _show(self, values: Mapping[str, Any], reviewed: SystemReview) -> list[str]:
        """Show the values of a link with its system; returns messages for invalid ones."""
        fitting, problems = fit_to_system(values, reviewed)
        shown = ViewState(**fitting)
        self._navigating = True
        try:
            # A link can add figures and buttons: Bokeh searches the models of the page once for all of them.
            with pn.io.hold(), self._document.models.freeze():
                self.state.show(reviewed, **{name: getattr(shown, name) for name in LINKED})
        finally:
            self._navigating = False
        self._follow_history()
        return problems

    def _write(self, *events: Any) -> None:
        """Show the state as the address; a choice among the orbits is not an entry of the browser's history."""
        if not self._navigating:
            entry = self.history.entry if {event.name for event in events} == {"chosen"} else self.history.record()
            self._browser.write_link(write_link(self.state), entry)
        self._follow_history()

    def _follow_history(self) -> None:
        self._toolbar.follow(self.history, zoomed=self.state.window is not None)
