"""The stylesheet defines every token it uses, in both themes, and loads nothing."""

from __future__ import annotations

import re

import panel as pn
from bokeh.document import Document
from bokeh.models import InlineStyleSheet

from app.views.components.theme import ExplorerDesign, theme_css

COLOUR = r"(#[0-9a-f]{6}|rgb\([^)]+\))"
THEMED_COLOUR = re.compile(rf"light-dark\({COLOUR}, {COLOUR}\)")


TOKENS = "".join(re.findall(r"^:root \{(.*?)^\}", theme_css(), re.MULTILINE | re.DOTALL))


def test_every_token_is_defined() -> None:
    assert set(re.findall(r"var\((--ui-[a-z-]+)", theme_css())) <= set(re.findall(r"^  (--ui-[a-z-]+):", TOKENS, re.M))


def test_the_dark_theme_changes_every_colour() -> None:
    pairs = THEMED_COLOUR.findall(TOKENS)
    assert len(pairs) > 10
    assert all(light != dark for light, dark in pairs)
    assert not re.search(COLOUR, THEMED_COLOUR.sub("", TOKENS))


def test_all_widgets_of_a_document_share_one_stylesheet() -> None:
    document = Document()
    row = pn.Row(pn.widgets.Button(label="a"), pn.widgets.Select(label="b"), design=ExplorerDesign)
    row.server_doc(document)
    sheets = {id(sheet) for model in document.models for sheet in getattr(model, "stylesheets", []) if is_theme(sheet)}
    assert len(sheets) == 1


def is_theme(sheet: object) -> bool:
    return isinstance(sheet, InlineStyleSheet) and sheet.css == theme_css()
