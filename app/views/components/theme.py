"""The look of the page: one stylesheet for the page frame and all widgets."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from bokeh.document import Document
from bokeh.models import InlineStyleSheet
from panel.theme.base import Design, Inherit, Theme
from panel.viewable import Viewable

THEME_KEY = "escape-explorer-theme"
"""Key of the chosen theme, "light" or "dark", in the browser's local storage."""

_STYLESHEET = Path(__file__).parents[2] / "static" / "theme.css"


@cache
def theme_css() -> str:
    """Return the text of the stylesheet."""
    return _STYLESHEET.read_text(encoding="utf-8")


class PlainTheme(Theme):
    """A theme without stylesheets of its own: Panel's themes look for their files at each change of a component."""

    _name = "default"


class ExplorerDesign(Design):
    """Gives all components of a page the same Bokeh model of the stylesheet."""

    modifiers = {Viewable: {"stylesheets": [Inherit, "theme"]}}  # noqa: RUF012
    _themes = {"default": PlainTheme, "dark": PlainTheme}  # noqa: RUF012

    @classmethod
    def _patch_modifiers(cls, doc: Document | None, modifiers: dict[str, Any], cache: dict[str, Any] | None) -> None:
        if "stylesheets" in modifiers:
            sheets = cache if cache is not None else {}
            if "theme" not in sheets:
                sheets["theme"] = InlineStyleSheet(css=theme_css())
            modifiers["stylesheets"] = [sheets["theme"]]
