"""A short tour of the page: a card at the bottom that leaves the page in use, so that each step can be tried at once."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import panel as pn
import param
from panel.custom import JSComponent


@dataclass(frozen=True)
class Step:
    """One card of the tour."""

    heading: str
    text: str


STEPS = (
    Step(
        "One start, one pixel",
        "Every pixel is the start of an orbit in a well with several ways out. The maps show what becomes of it: "
        "through which exit it leaves, when it leaves, and how often it crosses y = 0 before.",
    ),
    Step(
        "Change the energy",
        "Drag the energy slider, or press play. Just above the escape energy the exits are narrow and many orbits stay "
        "for ever; higher up the exits widen, the islands of bounded orbits shrink, and most orbits leave at once.",
    ),
    Step(
        "Zoom into the fractal",
        "Turn the wheel over any map, or drag a box: the region is computed anew. "
        "Where the colours stay mixed however far you zoom, no measurement is sharp enough to foretell the exit.",
    ),
    Step(
        "Look at one orbit",
        "Click a pixel. You get the path of its orbit, its SALI, which drops exponentially when the orbit is chaotic, "
        "and R² = x² + y², which shows how far out it swings and when it leaves.",
    ),
    Step(
        "Compare and count",
        "Find the twin of an orbit, a start very close by that leaves elsewhere, and watch how the two part. "
        "The numbers count all starts in view: the share of each exit, and how fast the well empties.",
    ),
    Step(
        "See why",
        "Switches above the maps mark the pixels that rounding decides, draw the curves that bound the basins, and tell where "
        "orbits came from. Others measure how fractal the picture is, and how it all changes with the energy.",
    ),
    Step(
        "Take it along",
        "The address of the page is a link to what you see; pictures and data can be saved. "
        "The gallery leads to places worth a visit.",
    ),
)

_CARD = """
const CARD = `<section role="dialog" aria-modal="false" aria-labelledby="heading" tabindex="-1" hidden>
  <div aria-live="polite"><h2 id="heading"></h2><p></p></div>
  <footer><span></span><button>Skip</button><button>Back</button><button>Next</button></footer>
</section>`

function deepest_focus() {
  let focused = document.activeElement
  while (focused?.shadowRoot?.activeElement) focused = focused.shadowRoot.activeElement
  return focused
}

export function render({model, el}) {
  el.innerHTML = CARD
  const [card, heading, text, count] = ["section", "h2", "p", "span"].map(tag => el.querySelector(tag))
  const [skip, back, next] = el.querySelectorAll("button")
  let before = null
  const show = () => {
    const step = model.steps[model.step], last = model.step === model.steps.length - 1
    heading.textContent = step.heading
    text.textContent = step.text
    count.textContent = `${model.step + 1} of ${model.steps.length}`
    next.textContent = last ? "Done" : "Next"
    skip.hidden = last
    // A disabled button would drop the focus of whoever has just pressed it.
    back.setAttribute("aria-disabled", String(model.step === 0))
  }
  const open = () => {
    if (model.running !== card.hidden) return
    const inside = card.contains(deepest_focus())
    if (model.running) before = deepest_focus()
    card.hidden = !model.running
    if (model.running || inside) (model.running ? card : before)?.focus({preventScroll: true})
  }
  skip.onclick = () => model.send_msg("stop")
  back.onclick = () => model.send_msg("back")
  next.onclick = () => model.send_msg("next")
  card.onkeydown = event => {
    if (event.key !== "Escape") return
    event.preventDefault()
    model.send_msg("stop")
  }
  model.on("step", show)
  model.on("running", open)
  show()
  open()
}
"""

_STYLE = """
section {
  position: fixed; bottom: 12px; left: 50%; transform: translateX(-50%); z-index: 1300; box-sizing: border-box;
  width: min(560px, calc(100vw - 24px)); padding: 12px 16px 8px; border-radius: 8px; font-size: 15px; line-height: 1.45;
  border: 1px solid color-mix(in srgb, currentColor 30%, transparent); box-shadow: 0 4px 24px rgb(0 0 0 / 35%);
  color: var(--panel-on-surface-color, CanvasText); background: var(--panel-surface-color, Canvas);
}
[hidden] { display: none }
section:focus { outline: none }
:focus-visible { outline: 3px solid var(--panel-primary-color, Highlight); outline-offset: 1px }
h2 { font-size: 17px; margin: 0 0 4px }
p { margin: 0 0 8px }
footer { display: flex; align-items: center; gap: 4px }
span { flex: 1; font-size: 13px }
button { font: inherit; color: inherit; background: none; border: 0; border-radius: 4px; padding: 8px 14px; cursor: pointer }
button:hover { text-decoration: underline }
button[aria-disabled=true] { opacity: .45; cursor: default; text-decoration: none }
button:last-child { color: var(--panel-on-primary-color, HighlightText); background: var(--panel-primary-color, Highlight) }
"""


# Its name has no underscore in front: Bokeh tells the browser of no such model.
class TourCard(JSComponent):
    """The card in the browser; its messages are "back", "next" and "stop"."""

    steps = param.List(default=[asdict(step) for step in STEPS])
    step = param.Integer(default=0, bounds=(0, len(STEPS) - 1))
    running = param.Boolean(default=False)

    _esm = _CARD


class Tour:
    """Shows `STEPS` one after another; `start` begins anew, Escape or the last button ends it."""

    def __init__(self) -> None:
        self._card = TourCard(width=0, height=0, margin=0, styles={"position": "absolute"}, stylesheets=[_STYLE])
        self._card.on_msg(lambda event: self._hear(event.data))

    def layout(self) -> pn.viewable.Viewable:
        """The card, which hangs at the bottom of the window wherever this stands on the page."""
        return self._card

    @property
    def running(self) -> bool:
        """Whether the card is open."""
        return bool(self._card.running)

    @property
    def step(self) -> Step:
        """The step shown, or to be shown first."""
        return STEPS[self._card.step]

    def start(self) -> None:
        """Open the card at the first step."""
        self._card.param.update(step=0, running=True)

    def stop(self) -> None:
        """Close the card."""
        self._card.running = False

    def next(self) -> None:
        """Go on; after the last step the tour is over."""
        if self.step is STEPS[-1]:
            self.stop()
        else:
            self._card.step += 1

    def back(self) -> None:
        """Go back, from the first step to itself."""
        self._card.step = max(self._card.step - 1, 0)

    def _hear(self, message: Any) -> None:
        match message:
            case "back":
                self.back()
            case "next":
                self.next()
            case "stop":
                self.stop()
