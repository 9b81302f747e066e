"""Panes of text keep their stylesheets when the text changes, also while they are off the page."""

from __future__ import annotations

import panel as pn
import pytest
from bokeh.document import Document
from bokeh.models import ImportedStyleSheet
from panel.io.resources import LOCAL_DIST

from app.views.components.texts import StatusPane, TextPane, breakable, plain_symbol


@pytest.mark.parametrize("kind", [TextPane, StatusPane])
@pytest.mark.parametrize("is_on_the_page", [True, False])
def test_a_new_text_changes_no_stylesheet(kind: type[TextPane], is_on_the_page: bool) -> None:
    pane, document = kind("before"), Document()
    # The template variables are those of a document of the server.
    document.template_variables["dist_url"] = LOCAL_DIST
    column = pn.Column(pane)
    root = column.get_root(document)
    document.add_root(root)
    model = root.children[0]
    before = [sheet.url for sheet in model.stylesheets if isinstance(sheet, ImportedStyleSheet)]
    if not is_on_the_page:
        document.remove_root(root)
    pane.object = "after"
    assert model.text == "after"
    assert [sheet.url for sheet in model.stylesheets if isinstance(sheet, ImportedStyleSheet)] == before


def test_lines_of_a_formula_break_before_operators_outside_brackets() -> None:
    lines = [line.replace("\N{NO-BREAK SPACE}", " ") for line in breakable("V = ½(x² + y²) − x(x²/3 − y²)").split(" ")]
    assert lines == ["V = ½(x² + y²)", "− x(x²/3 − y²)"]


@pytest.mark.parametrize(
    ("text", "shown"),
    [("ω1", "ω₁"), ("k3", "k₃"), ("mean of ω2, ε", "mean of ω₂, ε"), ("px", "px"), ("10 t2", "10 t₂"), ("log10", "log10")],
)
def test_the_digit_of_a_symbol_is_a_subscript(text: str, shown: str) -> None:
    assert plain_symbol(text) == shown
