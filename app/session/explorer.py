"""The explorer of one session: its presenters and views, and the handling of the browser's keys and other events."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import cached_property, partial
from typing import Any

import panel as pn

from app.job_clients.shown_results import ShownResults
from app.runtime.disconnects import on_disconnect
from app.runtime.process_state import process_state
from app.runtime.session_callbacks import SessionCallbacks
from app.runtime.visitors import account_of
from app.session.analysis_presenter import AnalysisPresenter
from app.session.comparison_presenter import ComparisonPresenter
from app.session.context import SessionContext
from app.session.link_presenter import LinkPresenter
from app.session.map_presenter import MapPresenter
from app.session.orbit_presenter import OrbitPresenter
from app.session.potential_presenter import PotentialPresenter
from app.session.study_presenter import StudyPresenter
from app.state.help_texts import HELP_TEXTS, title_with_help
from app.state.navigation import WINDOW_MOVES
from app.state.permalink import preset_view
from app.state.view import Analysis
from app.state.watched_starts import WATCH_KEY
from app.views.analysis.live_section import LiveSection
from app.views.analysis.statistics import StatisticsView
from app.views.components.collapsible_section import Drawers, Stack
from app.views.components.notice import Notice
from app.views.components.texts import TextPane
from app.views.orbits.ensemble_player import EnsemblePlayer
from app.views.panels.analysis_choice import analysis_tabs
from app.views.panels.browser_events import KEYS, PICTURE_KEYS, BrowserEvents
from app.views.panels.controls import Controls
from app.views.panels.downloads import Downloads
from app.views.panels.embedding import embed_code, page_address, page_host
from app.views.panels.gallery import Gallery
from app.views.panels.help import help_panes
from app.views.panels.slice_panel import SlicePanel
from engine import System
from engine.jobs.client import JobClient
from engine.systems.system import TYPED
from plots.links.presets import Preset
from plots.studies.section import SECTION_STUDY
from plots.studies.table import STUDIES, studies_by_tab


class Explorer:
    """Makes and connects the state, results, presenters and views of one session.

    Parameters
    ----------
    loop
        The event loop of the server; None if the explorer is made on the thread of the loop.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop | None = None) -> None:
        document = pn.state.curdoc
        assert document is not None, "an Explorer belongs to a session: start it with 'panel serve app'"
        self._document = document
        callbacks = SessionCallbacks(document, loop)
        # Panel may run callbacks of widgets without the session's lock, but changes of Bokeh models need the lock.
        self._locked = callbacks.every
        self._client = JobClient(process_state().jobs, account=account_of(document))
        on_disconnect(document, self._client.close)
        self.links = LinkPresenter(document, _link_parameters())
        if self.links.view.system.case == TYPED:
            # The process that reviews the formula starts while the page is made and loaded.
            process_state().limited.start()
        self.state, self.results, self.notice = self.links.state, ShownResults(), Notice()
        self._context = SessionContext(
            self.state, self.results, self._client, self.notice, callbacks.every, callbacks.latest, self._copy, self._open_view
        )
        self._make_presenters(self._context)
        self._make_views()
        self.state.follow(self.analysis.show, "analysis")
        self.links.connect(self.potential, self.browser, self.maps.progress, self.notice)
        pn.state.on_session_destroyed(self.close)
        pn.state.onload(lambda: self.links.begin(self._begin_view))

    def _make_presenters(self, context: SessionContext) -> None:
        self.maps = MapPresenter(context, self.links.history, alone=self.links.embedded)
        self.potential = PotentialPresenter(context, self.links.history, self.maps.view.well.show_sketch)
        self.analyses = AnalysisPresenter(context, self.maps.view)
        self.comparison = ComparisonPresenter(
            context, self.maps.view, lambda sentence: self.analyses.show_notes(compared=sentence), self.links.refuse_comparison
        )
        self.orbits = OrbitPresenter(context, self.maps.view.marks, self.maps.view.well, self.maps.add_start)
        self.engine = self.maps.engine

    def _make_views(self) -> None:
        state, results, locked = self.state, self.results, self._locked
        self.statistics = StatisticsView(state, results, self._copy)
        self.gallery = Gallery(state, locked(self._show_preset), locked(self._take_tour))
        keys = WINDOW_MOVES if self.links.embedded else KEYS
        self.browser = BrowserEvents(state, keys, locked, self._press, self.links.navigate, self._copied)
        lock_times = lambda on: state.param.update(lock_times=self.maps.view.times if on else None)  # noqa: E731
        self.controls = Controls(state, self.engine, self._toggle_drawer, self.comparison.swap_views, lock_times)
        self.drawers = Drawers(
            {
                "potential": ("", "Potential", self.potential.panel.parts()),
                "slice": ("", "Slice", [lambda: SlicePanel(state).build()]),
                "gallery": ("Gallery", "Gallery", [self.gallery.build]),
                "share": ("Share", "Share and download", [self._build_downloads]),
                "help": ("Help", "Help", [lambda: help_panes(state, results, self._take_tour)]),
            },
            self._follow_drawers,
            self._later,
        )
        self.analysis = Stack(
            {
                Analysis.ORBIT: [lambda: [self.orbits.inspector.layout(), self.gallery.invitation()]],
                Analysis.STATISTICS: self.statistics.parts(),
                Analysis.MEASURES: self.analyses.measures.parts(),
                **{name: [partial(self._build_study, each) for each in names] for name, names in studies_by_tab().items()},
                SECTION_STUDY.name: [
                    partial(self._build_study, SECTION_STUDY.name),
                    lambda: [LiveSection(state, results, locked, self._context.change)],
                ],
                Analysis.WATCH: [self._build_watch],
            },
            "analysis",
            head=[analysis_tabs(state)],
            later=self._later,
        )

    def _later(self, function: Callable[[], None]) -> Callable[[], None]:
        """Wrap a function to run in a later iteration of the event loop, or at once while the page is built."""
        run_later = self._locked(function)
        return lambda: run_later() if pn.state.loaded else function()

    def _toggle_drawer(self, name: str) -> None:
        self.drawers.toggle(name)
        if self.drawers.shown == "potential":
            # The process that reviews a formula starts while the visitor types.
            process_state().limited.start()

    def _follow_drawers(self, is_open: bool) -> None:
        self.browser.focus_drawer(is_open)
        self.potential.set_open(self.drawers.shown == "potential")

    @cached_property
    def _player(self) -> EnsemblePlayer:
        return EnsemblePlayer(self.state, self.results, self._client, self._locked)

    def _build_downloads(self) -> list[pn.viewable.Viewable]:
        may_embed = bool(process_state().settings.ancestors_at(page_host(self._document)))
        copy_link, on_copied = partial(self._copy, None), self._locked(self._copied)
        downloads = Downloads(self.state, self.results, copy_link, self._copy_embed_code, on_copied, may_embed=may_embed)
        return downloads.build()

    def _build_study(self, name: str) -> list[pn.viewable.Viewable]:
        return StudyPresenter(STUDIES[name], self._context).view.build()

    def _build_watch(self) -> list[pn.viewable.Viewable]:
        title = TextPane(title_with_help("Many orbits at once", "watch", HELP_TEXTS["watch"]), margin=(0, 10))
        return [title, self._player]

    def _watch(self) -> None:
        """Show the player of many orbits, and play or pause it."""
        # On a phone, the drawer covers the player.
        self.drawers.show(None)
        self.state.analysis = Analysis.WATCH
        self._player.press()

    def close(self, *_: Any) -> None:
        """Cancel all requests at the end of the session."""
        self._client.close()

    def _begin_view(self) -> None:
        """Show the first view; presenters then follow the changes of the state."""
        self.engine.show_view()
        self.maps.requests.request_map()
        self.orbits.begin()

    def _open_view(self, system: System, values: dict[str, Any]) -> None:
        """Review a system, then show it with the given values of the state."""
        self.links.open(system, partial(self.state.show, **values))

    def _show_preset(self, preset: Preset) -> None:
        self.engine.stop()
        # On a phone, the drawer covers the maps.
        if self.state.touch:
            self.drawers.show(None)
        self._open_view(preset_view(preset).system, preset_view(preset).within_limits().values())

    def _take_tour(self) -> None:
        # A drawer would cover what the tour is about.
        self.drawers.show(None)
        self._later(self.browser.begin_tour)()

    def _copied(self, success: bool) -> None:
        self.notice.show("Copied." if success else "The browser does not allow copying.")

    def _copy(self, text: str | None) -> None:
        """Copy a text; None copies the address of the page."""
        self.browser.copy(text)

    def _copy_embed_code(self) -> None:
        self._copy(embed_code(page_address(self._document.session_context.request), self.state))

    def _press(self, key: str) -> None:
        """Handle a key of `KEYS`."""
        actions: dict[str, Callable[[], Any]] = {
            **{key: partial(self.maps.move, move.change) for key, move in WINDOW_MOVES.items()},
            "b": self.browser.go_back,
            "f": self.browser.go_forward,
            "p": self.engine.play,
            WATCH_KEY: self._watch,
            "Enter": self.maps.add_middle,
            "Escape": self._escape,
            "?": lambda: self.drawers.toggle("help"),
            **{key: partial(self.state.enlarge, name) for key, name in PICTURE_KEYS.items()},
        }
        try:
            actions[key]()
        except ValueError as error:
            self.notice.warn(str(error))

    def _escape(self) -> None:
        """Close the open drawer; if none is open, stop the animation, or show all pictures, or stop the map."""
        if self.drawers.shown is not None:
            self.drawers.show(None)
        elif self.engine.playing:
            self.engine.stop()
        elif self.state.focus:
            self.state.focus = ""
        else:
            self.maps.requests.stop_map()


def _link_parameters() -> dict[str, str]:
    """Return the parameters in the address of the page."""
    return {name: texts[0].decode(errors="replace") for name, texts in dict(pn.state.session_args or {}).items()}
