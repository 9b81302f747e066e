"""The look of the page: one stylesheet for the page frame and all widgets, and the button that changes the theme."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import param
from bokeh.document import Document
from bokeh.models import InlineStyleSheet
from panel.custom import JSComponent
from panel.theme.base import Design, Inherit
from panel.viewable import Viewable

THEME_KEY = "escape-explorer-theme"
"""Key of the chosen theme, "light" or "dark", in the browser's local storage."""

_STYLESHEET = Path(__file__).parents[2] / "static" / "theme.css"

_BUTTON = """
const ICONS = {
  light: `<circle cx="12" cy="12" r="4"/>
    <path d="M12 3v2M12 19v2M3 12h2M19 12h2M5.6 5.6 7 7M17 17l1.4 1.4M5.6 18.4 7 17M17 7l1.4-1.4"/>`,
  dark: '<path d="M20 14.5A8 8 0 0 1 9.5 4 8 8 0 1 0 20 14.5Z"/>',
}
const BUTTON = `<button type="button" aria-label="Dark theme"><svg viewBox="0 0 24 24" width="20" height="20" fill="none"
  stroke="currentColor" stroke-width="1.8" stroke-linecap="round" stroke-linejoin="round" aria-hidden="true"></svg></button>`

export function render({model, el}) {
  const root = document.documentElement
  el.innerHTML = BUTTON
  const button = el.querySelector("button")
  const show = () => {
    const dark = root.dataset.theme === "dark"
    button.setAttribute("aria-pressed", String(dark))
    button.querySelector("svg").innerHTML = ICONS[dark ? "dark" : "light"]
    model.dark = dark
  }
  button.onclick = () => {
    root.dataset.theme = root.dataset.theme === "dark" ? "light" : "dark"
    try { localStorage.setItem(model.storage_key, root.dataset.theme) } catch { /* storage is blocked */ }
    show()
    // Canvases do not follow the stylesheet by themselves.
    for (const view of Bokeh.index.all_views()) if (view.model.type === "Figure") view.request_repaint()
  }
  show()
}
"""

_BUTTON_STYLE = """
button {
  display: grid; place-items: center; width: var(--ui-control); height: var(--ui-control); padding: 0; border: 0;
  border-radius: var(--ui-radius); background: none; color: inherit; cursor: pointer;
}
button:hover { background: var(--ui-sunken) }
button:focus-visible { outline: none; box-shadow: var(--ui-focus) }
"""


@cache
def theme_css() -> str:
    """The text of the stylesheet."""
    return _STYLESHEET.read_text(encoding="utf-8")


class ExplorerDesign(Design):
    """Gives each component of a page the stylesheet, as one Bokeh model that they share."""

    modifiers = {Viewable: {"stylesheets": [Inherit, "theme"]}}  # noqa: RUF012

    @classmethod
    def _patch_modifiers(cls, doc: Document | None, modifiers: dict[str, Any], cache: dict[str, Any] | None) -> None:
        if "stylesheets" in modifiers:
            sheets = cache if cache is not None else {}
            modifiers["stylesheets"] = [sheets.setdefault("theme", InlineStyleSheet(css=theme_css()))]


# Bokeh does not register classes whose name starts with an underscore in the browser.
class ThemeButton(JSComponent):
    """Changes between light and dark and stores the choice; `dark` is what the browser shows."""

    dark = param.Boolean(default=False)
    storage_key = param.String(default=THEME_KEY, constant=True)

    _esm = _BUTTON
    _stylesheets = [_BUTTON_STYLE]  # noqa: RUF012
