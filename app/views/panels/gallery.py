"""The gallery: rows of cards, each of which opens a view, and a caption that describes it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import panel as pn
import param
from panel.custom import JSComponent

from app.state.presets import GROUPS, PRESETS, Preset
from plots.map_images import TITLES

HINT = "Each card opens a view with orbits to compare. Its caption appears here."

# Panel serves app/static below the address of the page, which ends in "app".
_THUMBNAILS = "app/static/gallery"

_CARDS = """
const make = (tag, attributes, ...children) => {
  const node = Object.assign(document.createElement(tag), attributes)
  node.append(...children)
  return node
}

// A toolbar is one stop of the Tab key; arrows move from card to card.
const STEPS = {ArrowRight: place => place + 1, ArrowLeft: place => place - 1, Home: () => 0, End: (place, count) => count - 1}

function walk(event, buttons) {
  const place = buttons.indexOf(event.target), next = buttons[STEPS[event.key]?.(place, buttons.length)]
  if (place < 0 || next === undefined) return
  event.preventDefault()
  buttons[place].tabIndex = -1
  next.tabIndex = 0
  next.focus()
}

function make_card(card, place, show) {
  // Set loading before src, or the picture is fetched at once, even if the gallery is closed.
  const picture = make("img", {loading: "lazy", alt: card.alt, width: 112, height: 112, src: card.thumbnail})
  const button = make("button", {type: "button", tabIndex: place ? -1 : 0}, make("span", {}, card.title), picture)
  const description = make("span", {hidden: true, id: `caption-${card.key}`}, card.caption)
  button.dataset.key = card.key
  button.setAttribute("aria-describedby", description.id)
  for (const event of ["pointerenter", "focus"]) button.addEventListener(event, () => show(card))
  for (const event of ["pointerleave", "blur"]) button.addEventListener(event, () => show(null))
  return [button, description]
}

export function render({model, el}) {
  const caption = make("p", {})
  // Screen readers get the captions as descriptions of the buttons.
  caption.setAttribute("aria-hidden", "true")
  let chosen = null
  const show = card => {
    const shown = card ?? chosen
    caption.replaceChildren(...(shown ? [make("b", {}, shown.title), ` ${shown.caption}`] : [model.hint]))
  }
  const strips = model.groups.map(group => {
    const strip = make("div", {})
    strip.setAttribute("role", "toolbar")
    strip.setAttribute("aria-label", `Gallery: ${group}`)
    const cards = model.cards.filter(card => card.group === group)
    strip.append(...cards.flatMap((card, place) => make_card(card, place, show)))
    const buttons = [...strip.querySelectorAll("button")]
    strip.addEventListener("keydown", event => walk(event, buttons))
    return make("section", {}, make("h3", {}, group), strip)
  })
  const body = make("div", {className: "gallery"}, ...strips, caption)
  body.addEventListener("click", event => {
    const button = event.target.closest("button")
    if (button === null) return
    chosen = model.cards.find(card => card.key === button.dataset.key)
    body.querySelector("[aria-current]")?.removeAttribute("aria-current")
    button.setAttribute("aria-current", "true")
    show(chosen)
    model.send_msg(chosen.key)
  })
  show(null)
  el.replaceChildren(body)
}
"""

_STYLE = """
:host { min-width: 0 }
.gallery { font-family: inherit; font-size: 14px; line-height: 1.4; color: inherit }
h3 { margin: 8px 0 4px; font-size: 13px; font-weight: 600; color: var(--ui-quiet) }
[role=toolbar] { display: grid; grid-template-columns: repeat(auto-fill, minmax(112px, 1fr)); gap: 6px }
button {
  display: flex; flex-direction: column; align-items: center; gap: 4px; box-sizing: border-box;
  padding: 7px; font: inherit; font-size: 12.5px; line-height: 1.25; color: inherit; background: var(--ui-surface);
  cursor: pointer; border: 1px solid var(--ui-edge); border-radius: var(--ui-radius-l);
}
button:hover { border-color: var(--ui-edge-strong) }
button:focus-visible { outline: none; box-shadow: var(--ui-focus) }
button[aria-current] { border-color: var(--ui-accent); background: var(--ui-accent-soft) }
img { order: -1; display: block; width: 100%; height: auto; border-radius: var(--ui-radius) }
p {
  position: sticky; bottom: -32px; z-index: 1; margin: 12px 0 -32px; padding: 10px 0 16px; min-height: 5em;
  border-top: 1px solid var(--ui-edge); background: var(--ui-surface);
}
"""


# Bokeh does not register classes whose name starts with an underscore in the browser.
class GalleryCards(JSComponent):
    """The cards in the browser; it sends the key of the card that is chosen."""

    cards = param.List(default=[])
    groups = param.List(default=list(GROUPS))
    hint = param.String(default=HINT)

    _esm = _CARDS


class Gallery:
    """Shows `PRESETS`; `on_preset` is called, without the session's lock, with the one that is chosen."""

    def __init__(self, on_preset: Callable[[Preset], None]) -> None:
        self._on_preset = on_preset
        self._presets = {preset.key: preset for preset in PRESETS}

    def build(self) -> list[pn.viewable.Viewable]:
        """The cards."""
        cards = GalleryCards(
            cards=[_card(preset) for preset in PRESETS], sizing_mode="stretch_width", margin=0, stylesheets=[_STYLE]
        )
        cards.on_msg(lambda event: self._receive(event.data))
        return [cards]

    def _receive(self, message: Any) -> None:
        # Messages come from a browser: ignore what is not expected.
        if isinstance(message, str) and message in self._presets:
            self._on_preset(self._presets[message])


def _card(preset: Preset) -> dict[str, str]:
    """The data of a preset's card."""
    return {
        "key": preset.key,
        "group": preset.group,
        "title": preset.title,
        "caption": preset.caption,
        "alt": f"{TITLES[preset.picture]}, case {preset.case}, {preset.plane.title}",
        "thumbnail": f"{_THUMBNAILS}/{preset.key}.png",
    }
