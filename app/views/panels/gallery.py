"""The gallery: a strip of cards, each of which opens a view; its caption tells what there is to see."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import panel as pn
import param
from panel.custom import JSComponent

from app.rendering.map_images import TITLES
from app.state.presets import GROUPS, PRESETS, Preset

HINT = "Every card opens a view, with orbits to compare. Its caption appears here."

# Panel serves app/static under the address of the page, which ends in "app".
_THUMBNAILS = "app/static/gallery"

_CARDS = """
const make = (tag, attributes, ...children) => {
  const node = Object.assign(document.createElement(tag), attributes)
  node.append(...children)
  return node
}

// A toolbar is one stop of the Tab key; arrows lead from card to card.
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
  // Lazy before it has a source, or it is fetched at once, though the gallery may be closed.
  const picture = make("img", {loading: "lazy", alt: card.alt, width: 112, height: 112, src: card.thumbnail})
  const button = make("button", {type: "button", tabIndex: place ? -1 : 0}, make("span", {}, card.title), picture)
  const words = make("span", {hidden: true, id: `caption-${card.key}`}, card.caption)
  button.dataset.key = card.key
  button.setAttribute("aria-describedby", words.id)
  for (const event of ["pointerenter", "focus"]) button.addEventListener(event, () => show(card))
  for (const event of ["pointerleave", "blur"]) button.addEventListener(event, () => show(null))
  return [button, words]
}

export function render({model, el}) {
  const caption = make("p", {})
  // Screen readers have the captions as descriptions of the buttons.
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
.gallery { container-type: inline-size; font-family: inherit; font-size: 14px; line-height: 1.4; color: inherit }
h3 { margin: 4px 0 0; font-size: 13px; font-weight: 600; opacity: .75 }
[role=toolbar] {
  display: flex; gap: 6px; padding: 4px; overflow-x: auto; overscroll-behavior-x: contain; scroll-padding: 4px;
  scrollbar-width: thin;
}
button {
  display: flex; flex: none; flex-direction: column; align-items: center; gap: 4px; box-sizing: border-box; width: 128px;
  padding: 7px; font: inherit; font-size: 12.5px; line-height: 1.25; color: inherit; background: none; cursor: pointer;
  border: 1px solid color-mix(in srgb, currentColor 22%, transparent); border-radius: 8px;
}
button:hover { background: color-mix(in srgb, currentColor 9%, transparent) }
button:focus-visible { outline: 3px solid var(--panel-primary-color, Highlight); outline-offset: -1px }
button[aria-current] {
  border-color: var(--panel-primary-color, currentColor); box-shadow: inset 0 0 0 2px var(--panel-primary-color, currentColor);
}
img { order: -1; display: block; width: 112px; height: 112px; border-radius: 4px }
p { margin: 4px 4px 0; max-width: 110ch; min-height: 4.3em }
@container (max-width: 700px) { p { min-height: 9.9em } }
"""


# Its name has no underscore in front: Bokeh tells the browser of no such model.
class GalleryCards(JSComponent):
    """The cards in the browser; its messages are the keys of those chosen."""

    cards = param.List(default=[])
    groups = param.List(default=list(GROUPS))
    hint = param.String(default=HINT)

    _esm = _CARDS


class Gallery:
    """Shows `PRESETS`; `on_preset(preset)` is told which was chosen, like a button's click without the session's lock."""

    def __init__(self, on_preset: Callable[[Preset], None]) -> None:
        self._on_preset = on_preset
        self._presets = {preset.key: preset for preset in PRESETS}
        self._cards = GalleryCards(
            cards=[_card(preset) for preset in PRESETS], sizing_mode="stretch_width", margin=(0, 5), stylesheets=[_STYLE]
        )
        self._cards.on_msg(lambda event: self._hear(event.data))

    def layout(self) -> pn.viewable.Viewable:
        """Two rows of cards, each of which scrolls, and a caption below."""
        return self._cards

    def _hear(self, message: Any) -> None:
        # It comes from a browser: whatever is not expected is not heard.
        if isinstance(message, str) and message in self._presets:
            self._on_preset(self._presets[message])


def _card(preset: Preset) -> dict[str, str]:
    """What the browser needs to know of a preset."""
    return {
        "key": preset.key,
        "group": preset.group,
        "title": preset.title,
        "caption": preset.caption,
        "alt": f"{TITLES[preset.picture]}, case {preset.case}, {preset.plane.value}",
        "thumbnail": f"{_THUMBNAILS}/{preset.key}.png",
    }
