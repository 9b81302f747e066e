"""Panes of text keep their stylesheets when the text changes, also while they are off the page."""

from __future__ import annotations

import panel as pn
import pytest
from bokeh.document import Document
from bokeh.models import ImportedStyleSheet
from panel.io.resources import LOCAL_DIST

from app.views.components.texts import StatusPane, TextPane, breakable, typeset


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


@pytest.mark.parametrize(
    ("text", "whole"),
    [
        ("Escaped at t = 3.6", "Escaped at t~=~3.6"),
        ("error ≤ 1.9 × 10⁻¹²", "error ≤~1.9~×~10⁻¹²"),
        ("97.5 % of 1 034 275 starts", "97.5_% of 1_034_275 starts"),
        ("x = y, exit 1 at 20 times", "x = y, exit 1 at 20 times"),
        ("e^6.51, like t^1.01, x^2", "e<sup>6.51</sup>, like t<sup>1.01</sup>, x^2"),
        ("<path d='M1 200'>1 200</path>", "<path d='M1 200'>1_200</path>"),
    ],
)
def test_lines_do_not_break_inside_a_number(text: str, whole: str) -> None:
    assert typeset(text) == whole.replace("~", "\N{NO-BREAK SPACE}").replace("_", "\N{NARROW NO-BREAK SPACE}")


def test_lines_of_a_formula_break_before_operators_outside_brackets() -> None:
    lines = [line.replace("\N{NO-BREAK SPACE}", " ") for line in breakable("V = ½(x² + y²) − x(x²/3 − y²)").split(" ")]
    assert lines == ["V = ½(x² + y²)", "− x(x²/3 − y²)"]
