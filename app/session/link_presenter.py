"""The links of the page: views of links in the address and the history are shown, and the link of each new state is written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import nullcontext
from functools import partial
from typing import Any
from urllib.parse import parse_qsl

import panel as pn
from bokeh.document import Document

from app.session.context import History
from app.session.potential_presenter import PotentialPresenter
from app.state.permalink import (
    EMBED,
    LINKED,
    fit_to_system,
    ignored_parameters,
    linked_view,
    read_link,
    refused_comparison,
    refused_link,
    unknown_parameters,
    without_system,
    write_link,
)
from app.state.system_review import PageReview, is_known, review_catalogue_entry
from app.state.view import PICTURES
from app.state.view_state import ViewState
from app.views.components.notice import Notice
from app.views.maps.progress import ProgressView
from app.views.panels.browser_events import BrowserEvents
from app.views.panels.embedding import OpenLink
from engine import System

# The fields of the view state whose changes add parts to the page and remove others.
_WITH_PARTS = ("analysis", "compared", "layers")


class LinkPresenter:
    """Makes the view state from the first link, shows later links, and writes the link of the state to the address.

    Parameters
    ----------
    document
        The document of the page.
    parameters
        Parameters of the page's address.
    """

    def __init__(self, document: Document, parameters: Mapping[str, str]) -> None:
        self._document = document
        self._link, self._problems = read_link(parameters)
        self._unknown = unknown_parameters(parameters)
        self._is_navigating = False
        # None until the other parts of the page are made. Problems that are found earlier are shown when the view begins.
        self._notice: Notice | None = None
        self.embedded = parameters.get(EMBED) in PICTURES
        """Whether the page shows only one picture, in a frame of another page."""
        self.open_link = OpenLink()
        self.history = History()
        self.view = linked_view(self._link)
        """The view of the link in the page's address."""
        self.state = self._first_state()

    def connect(
        self,
        potential: PotentialPresenter,
        browser: BrowserEvents,
        progress: ProgressView,
        notice: Notice,
    ) -> None:
        """Connect the links with the other parts of the page, and write a link for each change of the state.

        Parameters
        ----------
        potential
            Reviews the systems of links.
        browser
            Writes links to the address of the page.
        progress, notice
            Show that a review runs, and messages about links.
        """
        self._potential, self._browser = potential, browser
        self._progress, self._notice = progress, notice
        self.state.param.watch(self._write, list(LINKED))
        self.open_link.show(write_link(self.state))

    def begin(self, begin_view: Callable[[], object]) -> None:
        """Show the view of the first link once its system is reviewed. `begin_view` requests the results of the state."""
        system = self.view.system
        if is_known(system):
            begin_view()
            self._show_problems()
        else:
            self._review(system, self._begin_with_review, partial(self._begin_with_default, begin_view))

    def open(self, system: System, use: Callable[[PageReview], object]) -> None:
        """Review a system, then use it or say why it is refused."""
        self._review(system, use, self._refuse)

    def refuse_comparison(self, problem: str) -> None:
        """Show why the view with which a link compares the state is refused."""
        self._problems.append(refused_comparison(problem))
        self._show_problems()

    def navigate(self, link: str, entry: int, steps: int) -> None:
        """Show the view of a link in the browser's history, given the entry and the number of steps so far."""
        self._browser.follow_steps(steps)
        values, self._problems = read_link(dict(parse_qsl(link.removeprefix("?"))))
        self.history.move_to(entry)
        self.open(linked_view(values).system, partial(self._show_entry, values))

    def _first_state(self) -> ViewState:
        """Return the state of the first link, with the default system until the system of the link is reviewed."""
        if not is_known(self.view.system):
            return ViewState(**without_system(self._link))
        fitting, problems = fit_to_system(self._link, review_catalogue_entry(self.view.system.case))
        self._problems += problems
        return ViewState(**fitting)

    def _begin_with_review(self, reviewed: PageReview) -> None:
        """Show the view of the first link with its reviewed system."""
        self._problems += self._show(self._link, reviewed)
        self._show_problems()

    def _begin_with_default(self, begin_view: Callable[[], object], problem: str) -> None:
        """Show the default system in place of a refused system."""
        self._problems.append(refused_link(problem))
        begin_view()
        self._show_problems()

    def _show_problems(self) -> None:
        """Show the problems of the link until the view changes. Unknown parameters alone are shown for some seconds, once."""
        unknown = [ignored_parameters(self._unknown)] if self._unknown else []
        if self._problems:
            self._warn(" ".join([*self._problems, *unknown]))
        elif unknown and self._notice is not None:
            self._notice.show(*unknown)
        self._unknown = ()

    def _warn(self, sentence: str) -> None:
        if self._notice is not None:
            self._notice.warn(sentence)

    def _review(self, system: System, use: Callable[[PageReview], object], refuse: Callable[[str], None]) -> None:
        """Review a system, and say so while the review runs."""
        if self._potential.open(system, use, refuse):
            self._progress.show_reviewing()

    def _refuse(self, problem: str) -> None:
        self._progress.fail()
        self._warn(refused_link(problem))

    def _show(self, values: Mapping[str, Any], reviewed: PageReview) -> list[str]:
        """Show the values of a link with a reviewed system; return messages for invalid values."""
        fitting, problems = fit_to_system(values, reviewed)
        shown = ViewState(**fitting)
        # With the models frozen, Bokeh searches the page once for all models that the link adds or removes.
        adds_parts = any(getattr(shown, name) != getattr(self.state, name) for name in _WITH_PARTS)
        self._is_navigating = True
        try:
            with pn.io.hold(), self._document.models.freeze() if adds_parts else nullcontext():
                self.state.show(reviewed, **{name: getattr(shown, name) for name in LINKED})
        finally:
            self._is_navigating = False
        return problems

    def _show_entry(self, values: Mapping[str, Any], reviewed: PageReview) -> None:
        """Show the values of an entry of the browser's history, and write its address in normal form."""
        self._show(values, reviewed)
        self._write_address(self.history.entry)

    def _write(self, *events: Any) -> None:
        """Write the link of the state to the address. Choosing another orbit makes no entry in the browser's history."""
        if not self._is_navigating:
            # "Back" on a page also goes through the entries of its frames, so an embedded page makes no entries.
            makes_entry = not self.embedded and {event.name for event in events} != {"chosen"}
            self._write_address(self.history.record() if makes_entry else self.history.entry)
            if self.embedded:
                self.open_link.show(write_link(self.state))

    def _write_address(self, entry: int) -> None:
        self._browser.show_address(write_link(self.state, embedded=self.embedded), entry)
