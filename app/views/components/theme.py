"""The look of the page: one stylesheet for its HTML and all widgets, and colours that follow the theme."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from bokeh.core.property.vectorization import Field, Value
from bokeh.document import Document
from bokeh.models import CustomJSTransform, InlineStyleSheet
from panel.theme.base import Design, Inherit, Theme
from panel.viewable import Viewable

from plots.pictures.palette import DARK, LIGHT
from plots.texts.page_colours import page_colours

THEME_KEY = "escape-explorer-theme"
"""Key of the chosen theme, "light" or "dark", in the browser's local storage."""

# JavaScript of a transform. On a dark page, it replaces `x`, a colour on a light page, or each of the colours `xs`.
_THEME_COLOUR_CODE = "return document.documentElement.dataset.theme === 'dark' ? dark[x] : x"
_THEME_COLOURS_CODE = "return document.documentElement.dataset.theme === 'dark' ? xs.map(x => dark[x]) : xs"

_STYLESHEET = Path(__file__).parents[2] / "static" / "theme.css"


@cache
def theme_css() -> str:
    """Return the text of the stylesheet, which begins with the colours."""
    return page_colours() + _STYLESHEET.read_text(encoding="utf-8")


def theme_colour(name: str) -> str:
    """Return a colour of `LineColours` as a CSS colour, which follows the theme."""
    return f"light-dark({getattr(LIGHT, name)}, {getattr(DARK, name)})"


def theme_line(name: str) -> Value:
    """Return a colour of `LineColours` for the lines or texts of a glyph. A script of page.html applies each new theme."""
    return Value(getattr(LIGHT, name), transform=_theme_colours(name))


def theme_lines(column: str, *names: str) -> Field:
    """Return what `theme_line` does, for lines that have one of several colours, given for a light page in a column."""
    return Field(column, transform=_theme_colours(*names))


def _theme_colours(*names: str) -> CustomJSTransform:
    dark = {getattr(LIGHT, name): getattr(DARK, name) for name in names}
    return CustomJSTransform(args={"dark": dark}, func=_THEME_COLOUR_CODE, v_func=_THEME_COLOURS_CODE)


class PlainTheme(Theme):
    """A theme without stylesheets of its own: Panel's themes look for their files at each change of a component."""

    _name = "default"


class ExplorerDesign(Design):
    """Gives all components of a page the same Bokeh model of the stylesheet."""

    # `_patch_modifiers` puts the model in place of this list.
    modifiers = {Viewable: {"stylesheets": [Inherit, "theme"]}}  # noqa: RUF012
    _themes = {"default": PlainTheme, "dark": PlainTheme}  # noqa: RUF012

    @classmethod
    def loading_css(cls) -> str:
        """Return no rules: no component shows Panel's loading indicator, and each would have a stylesheet for it."""
        return ""

    @classmethod
    def _patch_modifiers(cls, doc: Document | None, modifiers: dict[str, Any], cache: dict[str, Any] | None) -> None:
        if "stylesheets" in modifiers:
            sheets = cache if cache is not None else {}
            if "theme" not in sheets:
                sheets["theme"] = InlineStyleSheet(css=theme_css())
            modifiers["stylesheets"] = [sheets["theme"]]
