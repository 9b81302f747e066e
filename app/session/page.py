"""The page: its frame, and where each view of an explorer stands in it."""

from __future__ import annotations

from functools import cache
from html import escape
from pathlib import Path
from typing import Any

import panel as pn
from bokeh.document import Document
from jinja2 import Template
from panel.io.resources import parse_template

from app.rendering.mathml import equations
from app.session.explorer import Explorer
from app.state.system import SYSTEM
from app.views.components.flex_row import flex_row
from app.views.components.notice import watch_connection
from app.views.components.theme import THEME_KEY, ExplorerDesign, ThemeButton, theme_css
from app.views.components.widgets import button
from app.views.panels.keyboard import key_legend

TITLE = "Escape Explorer"


@cache
def _frame() -> Template:
    """The page's HTML without its widgets."""
    frame: Template = parse_template(Path(__file__).with_name("page.html").read_text(encoding="utf-8"))
    return frame


class MainColumn(pn.Column):
    """The column of the page; the template stores the `repr` of its roots, which takes 0.2 s for all that is in it."""

    def __repr__(self, depth: int = 0, max_depth: int = 10) -> str:
        return type(self).__name__


class ExplorerTemplate(pn.Template):
    """The page of one session: a header and one column."""

    def __init__(self, header: pn.viewable.Viewable, main: pn.viewable.Viewable) -> None:
        super().__init__(_frame(), items={"header": header, "main": main}, design=ExplorerDesign, location=True)
        self.add_variable("theme_css", theme_css())
        self.add_variable("theme_key", THEME_KEY)

    def server_doc(self, doc: Document | None = None, title: str | None = TITLE, location: Any = True) -> Document:
        """Fill a document with the page."""
        document = super().server_doc(doc, title or TITLE, location)
        watch_connection(document)
        return document


def explorer_page(explorer: Explorer) -> ExplorerTemplate:
    """The page of one explorer."""
    main = MainColumn(
        explorer.gallery.section.layout(),
        explorer.downloads.section.layout(),
        explorer.controls.layout(),
        explorer.potential.panel.section.layout(),
        explorer.analyses.switches.layout(),
        explorer.progress.layout(),
        explorer.zoom_buttons.layout(),
        explorer.analyses.notes,
        explorer.maps.layout(),
        flex_row(explorer.orbit_controls.layout(explorer.playback.layout()), explorer.orbit_layout.layout(), justify="center"),
        explorer.statistics.section.layout(),
        explorer.analyses.measures.section.layout(),
        explorer.analyses.curves.section.layout(),
        _equations(explorer),
        pn.pane.HTML(f"<details><summary>Keys</summary>{key_legend()}</details>", margin=(4, 10)),
        explorer.accessible_table.layout(),
        explorer.keyboard.layout(),
        explorer.tour.layout(),
        explorer.notice.layout(),
        sizing_mode="stretch_width",
        margin=0,
    )
    return ExplorerTemplate(_header(explorer), main)


def _header(explorer: Explorer) -> pn.viewable.Viewable:
    theme = ThemeButton(margin=0)
    theme.param.watch(lambda event: explorer.set_dark(event.new), "dark")
    return pn.Row(
        button("Gallery", explorer.gallery.section.toggle, kind="light", margin=0),
        button("Share", explorer.downloads.section.toggle, kind="light", margin=0),
        button("Tour", explorer.tour.start, kind="light", margin=0),
        theme,
        margin=0,
    )


def _equations(explorer: Explorer) -> pn.pane.HTML:
    """The equations of motion of the system in view, collapsed."""
    state = explorer.state

    def html() -> str:
        return f"<details><summary>Equations: {escape(state.system.title)}</summary>{equations(state.potential)}</details>"

    pane = pn.pane.HTML(html(), margin=(4, 10), sizing_mode="stretch_width")
    state.param.watch(lambda *events: pane.param.update(object=html()), list(SYSTEM))
    return pane
