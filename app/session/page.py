"""The page: its HTML, the texts with which other programs show a link, and the layout of an explorer's views."""

from __future__ import annotations

import asyncio
from functools import cache
from pathlib import Path
from typing import Any

import panel as pn
from bokeh.document import Document
from jinja2 import Template
from panel.io.resources import parse_template
from panel.io.state import set_curdoc

from app.browser.module_files import ADDRESS
from app.session.explorer import Explorer
from app.state.view import View
from app.views.components.notice import watch_connection
from app.views.components.theme import THEME_KEY, ExplorerDesign, theme_css
from app.views.components.widgets import FULL_HEIGHT
from engine import System
from engine.foundations.wording import format_number
from engine.systems.formulas.formula_parser import formula_letters
from engine.systems.system import TYPED

TITLE = "Escape Explorer"

LONGEST_FORMULA = 80
"""Largest number of characters of a formula in a title."""


@cache
def _template() -> Template:
    """Return the HTML of the page without its widgets."""
    return parse_template(Path(__file__).with_name("page.html").read_text(encoding="utf-8"))


def link_title(view: View) -> str:
    """Return the name of the system, with a typed formula."""
    formula = _shown_formula(view.system)
    return f"{view.system.title}, V = {formula}" if formula else view.system.title


def link_sentence(view: View) -> str:
    """Describe the view in one sentence."""
    energy = "" if view.known_energy is None else f" at h = {format_number(view.known_energy, 6)}"
    return (
        f"{link_title(view)} on the plane {view.plane.title}{energy}: "
        "each start of an orbit has the colour of the exit through which the orbit leaves the well."
    )


def _shown_formula(system: System) -> str:
    """Return a typed formula without its clauses, which may contain names; empty for a long formula or one with unknown words.

    Other programs show the result as this server's words, whoever wrote the link.
    """
    formula = system.formula.partition(";")[0].strip() if system.case == TYPED else ""
    try:
        formula_letters(formula)
    except ValueError:
        return ""
    return formula if len(formula) <= LONGEST_FORMULA else ""


class RootColumn(pn.Column):
    """A part of the page with a short `repr`. The template stores the `repr` of each part, which would take 0.2 s in full."""

    def __repr__(self, depth: int = 0, max_depth: int = 10) -> str:
        return type(self).__name__


class ExplorerTemplate(pn.Template):
    """The page of one session: a header, the controls, and the stage with the maps."""

    def __init__(self, view: View, **roots: pn.viewable.Viewable) -> None:
        super().__init__(_template(), items=roots, design=ExplorerDesign, location=False)
        self.add_variable("link_title", link_title(view))
        self.add_variable("link_sentence", link_sentence(view))
        self.add_variable("is_embedded", "picture_alone" in roots)
        self.add_variable("preloaded_module", ADDRESS)
        self.add_variable("theme_css", theme_css())
        self.add_variable("theme_key", THEME_KEY)

    def server_doc(self, doc: Document | None = None, title: str | None = TITLE, location: Any = True) -> Document:
        """Fill a document with the page."""
        document = super().server_doc(doc, title or TITLE, location)
        watch_connection(document)
        return document


def build_page(document: Document, loop: asyncio.AbstractEventLoop) -> None:
    """Fill the document of a new session with a page; any thread may call this.

    Parameters
    ----------
    document
        The document, which has no page yet.
    loop
        The event loop of the server.
    """
    with set_curdoc(document):
        # Without this call, Panel loads the scripts of all its extensions.
        pn.extension()
        explorer_page(Explorer(loop)).server_doc(document)


def explorer_page(explorer: Explorer) -> ExplorerTemplate:
    """Return the page of an explorer, or, in a frame of another page, the page of one picture."""
    if explorer.links.embedded:
        return ExplorerTemplate(explorer.links.view, picture_alone=_picture_alone(explorer))
    return ExplorerTemplate(
        explorer.links.view,
        header=explorer.drawers.buttons,
        controls=_column(*explorer.controls.layout(), css_class="controls"),
        stage=_stage(explorer),
    )


def _picture_alone(explorer: Explorer) -> pn.viewable.Viewable:
    """Return the picture that is shown large, with the link to the whole page."""
    return _column(
        explorer.maps.progress.bar,
        explorer.maps.view.grid.layout(),
        explorer.links.open_link.pane,
        explorer.browser,
        explorer.engine,
        explorer.notice.layout(),
        css_class="picture-alone",
    )


def _stage(explorer: Explorer) -> pn.viewable.Viewable:
    """Return progress bar, maps, energy, notes, and the chosen analysis, which the stylesheet arranges."""
    return _column(
        explorer.maps.progress.bar,
        explorer.maps.toolbar.layout(*explorer.maps.progress.layout()),
        explorer.maps.view.grid.layout(),
        explorer.controls.energy,
        explorer.analyses.notes,
        explorer.analysis.layout(),
        explorer.drawers.layout(),
        explorer.browser,
        explorer.engine,
        explorer.notice.layout(),
        css_class="stage",
    )


def _column(*parts: pn.viewable.Viewable, css_class: str) -> pn.viewable.Viewable:
    return RootColumn(*parts, sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=[css_class])
