"""The gallery: cards that open views, and the caption of a card."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import panel as pn
import param

from app.browser.components.plain_component import PlainComponent
from app.state.tour import TOUR_LINE, TOUR_TITLE
from app.state.view_state import ViewState
from plots.layers.table import TITLES
from plots.links.presets import GROUPS, PRESETS, Preset
from plots.texts.typeset import typeset

INVITATION = "Each pixel of the basins is a start, and its colour the exit through which its orbit escapes. Views to begin with:"
"""Title of the invitation: cards on a page without orbits."""

HINT = "Each card opens a view with orbits to compare. Its caption appears here."
"""Text in place of a caption."""

# Panel serves the folder app/static below the page. The address of the page ends in "app", which a relative address replaces.
_THUMBNAILS = "app/static/gallery"

_STYLE = """
:host { min-width: 0 }
.gallery { font-family: inherit; font-size: 0.875rem; line-height: 1.4; color: inherit }
[hidden] { display: none !important }
input {
  box-sizing: border-box; width: 100%; height: var(--ui-control); padding: 0 10px; border: 1px solid var(--ui-edge);
  border-radius: var(--ui-radius); background: var(--ui-surface); color: inherit; font: inherit;
}
h3 { margin: 8px 0 4px; font-size: inherit; font-weight: 600 }
[role=toolbar] { display: grid; grid-template-columns: repeat(auto-fill, minmax(112px, 1fr)); gap: 6px }
.few h3 { margin: 8px 0; font-weight: inherit }
.few [role=toolbar] { grid-template-columns: repeat(auto-fill, minmax(min(16rem, 100%), 1fr)) }
button {
  display: flex; flex-direction: column; align-items: center; gap: 4px; box-sizing: border-box;
  padding: 7px; font: inherit; line-height: 1.25; color: inherit; background: var(--ui-surface);
  cursor: pointer; border: 1px solid var(--ui-edge); border-radius: var(--ui-radius-l);
}
button:hover { border-color: var(--ui-edge-strong) }
button:focus-visible { outline: none; box-shadow: var(--ui-focus) }
button[aria-current] { border-color: var(--ui-accent); background: var(--ui-accent-soft) }
small { font-size: 0.75rem; color: var(--ui-quiet) }
img { order: -1; display: block; width: 100%; height: auto; border-radius: var(--ui-radius) }
/* The picture beside the title and the line below it. */
.few button { display: grid; grid-template-columns: 3.5rem 1fr; gap: 2px 12px; align-items: end; text-align: left }
.few img { grid-row: 1 / 3 }
.few small { align-self: start }
p {
  position: sticky; bottom: -32px; z-index: 1; margin: 12px 0 -32px; padding: 10px 0 16px; min-height: 5em;
  border-top: 1px solid var(--ui-edge); background: var(--ui-surface);
}
/* A finger shows no caption before it chooses a card. */
@media (hover: none) { .hint { display: none } }
/* On a phone, the drawer has the height of two cards. */
@media (max-width: 37.49em) {
  .gallery:not(.few) [role=toolbar] { grid-template-columns: 1fr 1fr }
  .gallery:not(.few) button { flex-direction: row; text-align: left }
  .gallery:not(.few) img { flex: none; width: 3rem }
}
"""


# The data of the card of the tour, as those of `_card`.
_TOUR_CARD = {
    "key": "tour",
    "group": INVITATION,
    "title": TOUR_TITLE,
    "caption": "",
    "line": TOUR_LINE,
    "alt": "",
    "thumbnail": f"{_THUMBNAILS}/basins-in-phase-space.png",
}


# In the browser, Bokeh does not register classes whose name starts with an underscore.
class GalleryCards(PlainComponent):
    """Shows cards in the browser, and sends the key of the chosen card."""

    cards = param.List(default=[], doc="data of each card, see `_card`")
    groups = param.List(default=[], doc="titles of the groups, in order")
    hint = param.String(default="", doc="text in place of a caption; empty for cards without captions below them")

    _esm = Path(__file__).with_suffix(".js")


class Gallery:
    """Shows `PRESETS`. It passes the chosen preset to `on_preset`, or calls `on_tour`, without the session's lock."""

    def __init__(self, state: ViewState, on_preset: Callable[[Preset], None], on_tour: Callable[[], None]) -> None:
        self._on_preset, self._on_tour = on_preset, on_tour
        self._presets = {preset.key: preset for preset in PRESETS}
        self._invitation: GalleryCards | None = None
        self._state = state
        state.param.watch(lambda event: self._show_invitation(), "starts")

    def build(self) -> list[pn.viewable.Viewable]:
        """Make the cards of all presets."""
        return [self._make_cards([_card(preset) for preset in PRESETS], groups=list(GROUPS), hint=HINT)]

    def invitation(self) -> pn.viewable.Viewable:
        """Return the invitation: the tour and some of the cards in one group, for a page without orbits."""
        if self._invitation is None:
            cards = [_TOUR_CARD] + [
                {**_card(preset), "group": INVITATION, "line": typeset(preset.invitation)}
                for preset in PRESETS
                if preset.invitation
            ]
            self._invitation = self._make_cards(cards, groups=[INVITATION], hint="", margin=(0, 10))
            self._show_invitation()
        return self._invitation

    def _show_invitation(self) -> None:
        """Show the invitation while there are no starts."""
        if self._invitation is not None:
            self._invitation.visible = self._state.starts == ()

    def _make_cards(self, cards: list[dict[str, str]], **options: Any) -> GalleryCards:
        gallery_cards = GalleryCards(cards=cards, sizing_mode="stretch_width", stylesheets=[_STYLE], **({"margin": 0} | options))
        gallery_cards.on_msg(lambda event: self._choose(event.data))
        return gallery_cards

    def _choose(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        if isinstance(message, str) and message in self._presets:
            self._on_preset(self._presets[message])
        elif message == _TOUR_CARD["key"]:
            self._on_tour()


def _card(preset: Preset) -> dict[str, str]:
    """Return the data of a preset's card."""
    view = preset.map_view
    return {
        "key": preset.key,
        "group": preset.group,
        "title": preset.title,
        "caption": preset.caption,
        "line": "",
        "alt": f"{TITLES[preset.picture]}, case {view.system.case}, {view.plane.title}",
        "thumbnail": f"{_THUMBNAILS}/{preset.key}.png",
    }
