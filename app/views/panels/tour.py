"""A short tour of the page, in a card at the bottom that points at its subject; the page stays usable."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Any

import panel as pn
import param
from panel.custom import JSComponent


class Act(StrEnum):
    """What a step of the tour can do on the page."""

    PLAY = "play"
    ZOOM = "zoom"
    ORBIT = "orbit"
    TWIN = "twin"
    LAYER = "layer"
    GALLERY = "gallery"


@dataclass(frozen=True)
class Step:
    """One card of the tour.

    Attributes
    ----------
    heading, text
        Texts of the card.
    target
        CSS class of the part of the page that the step points at.
    act
        What the button "Show me" does.
    """

    heading: str
    text: str
    target: str
    act: Act | None = None


STEPS = (
    Step(
        "One start, one pixel",
        "Every pixel is the start of an orbit in a well with several exits. The maps show through which exit the orbit "
        "escapes, when it escapes, and how often it crosses y = 0 before.",
        "maps",
    ),
    Step(
        "Change the energy",
        "Drag the energy slider, or press Play. Just above the escape energy the exits are narrow and many orbits never "
        "escape; at higher energies the exits widen, the islands of bounded orbits shrink, and most orbits escape at once.",
        "energy",
        Act.PLAY,
    ),
    Step(
        "Zoom into the fractal",
        "Turn the wheel over any map, or drag a box: the region is computed again. "
        "Where the colours stay mixed at every zoom, no measurement of the start is exact enough to predict the exit.",
        "maps",
        Act.ZOOM,
    ),
    Step(
        "Follow one orbit",
        "Click a pixel. You get the path of its orbit, its SALI, which drops exponentially if the orbit is chaotic, "
        "and R² = x² + y², which shows how far out it goes and when it escapes.",
        "inspector",
        Act.ORBIT,
    ),
    Step(
        "Compare and count",
        "Find the twin of an orbit, a start very close by that escapes through another exit, and see how the two separate. "
        "The statistics count all starts in view: the share of each exit, and how fast the well empties.",
        "inspector",
        Act.TWIN,
    ),
    Step(
        "Understand the picture",
        "The layers mark the pixels that depend on rounding, draw the curves that bound the basins, and show where orbits come "
        "from. The analyses beside the maps measure how fractal the basins are, and how everything changes with the energy.",
        "switches",
        Act.LAYER,
    ),
    Step(
        "Share and download",
        "The address of the page is a link to what you see; Share saves pictures and data. The gallery opens interesting views.",
        "drawer-buttons",
        Act.GALLERY,
    ),
)

_CARD = """
const CARD = `<section role="dialog" aria-modal="false" aria-labelledby="heading" tabindex="-1" hidden>
  <div aria-live="polite"><h2 id="heading"></h2><p></p></div>
  <footer><span></span><button>Skip</button><button>Show me</button><button>Back</button><button>Next</button></footer>
</section>`

// Parts of the page are inside of shadow roots.
function find(root, name) {
  const found = root.querySelector(`.${name}`)
  if (found) return found
  for (const node of root.querySelectorAll("*")) {
    const inside = node.shadowRoot && find(node.shadowRoot, name)
    if (inside) return inside
  }
  return null
}

function deepest_focus() {
  let focused = document.activeElement
  while (focused?.shadowRoot?.activeElement) focused = focused.shadowRoot.activeElement
  return focused
}

export function render({model, el}) {
  el.innerHTML = CARD
  const [card, heading, text, count] = ["section", "h2", "p", "span"].map(tag => el.querySelector(tag))
  const [skip, act, back, next] = el.querySelectorAll("button")
  let before = null, pointed = null
  const point = target => {
    if (pointed) pointed.style.outline = ""
    pointed = target && find(document, target)
    if (!pointed) return
    pointed.style.outline = "2px solid var(--ui-accent)"
    pointed.scrollIntoView({block: "nearest"})
  }
  const show = () => {
    const step = model.steps[model.step], last = model.step === model.steps.length - 1
    heading.textContent = step.heading
    text.textContent = step.text
    count.textContent = `${model.step + 1} of ${model.steps.length}`
    next.textContent = last ? "Done" : "Next"
    skip.hidden = last
    act.hidden = !step.act
    point(model.running ? step.target : null)
    // A button loses the focus when it is disabled.
    back.setAttribute("aria-disabled", String(model.step === 0))
  }
  const open = () => {
    if (model.running !== card.hidden) return
    const inside = card.contains(deepest_focus())
    if (model.running) before = deepest_focus()
    card.hidden = !model.running
    show()
    if (model.running || inside) (model.running ? card : before)?.focus({preventScroll: true})
  }
  skip.onclick = () => model.send_msg("stop")
  back.onclick = () => model.send_msg("back")
  act.onclick = () => model.send_msg("act")
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
  width: min(560px, calc(100vw - 24px)); padding: 14px 18px 10px; border-radius: var(--ui-radius-l);
  font-size: 15px; line-height: 1.45; border: 1px solid var(--ui-edge); box-shadow: var(--ui-shadow-l);
  color: var(--ui-ink); background: var(--ui-surface);
}
[hidden] { display: none }
section:focus { outline: none }
:focus-visible { outline: none; box-shadow: var(--ui-focus) }
h2 { font-size: 17px; margin: 0 0 4px }
p { margin: 0 0 8px }
footer { display: flex; align-items: center; gap: 4px }
span { flex: 1; font-size: 13px }
button {
  font: inherit; color: inherit; background: none; border: 0; border-radius: var(--ui-radius); padding: 6px 14px; cursor: pointer;
}
button:hover { background: var(--ui-sunken) }
button[aria-disabled=true] { opacity: .45; cursor: default }
button:last-child { color: var(--ui-on-accent); background: var(--ui-accent) }
"""


# Bokeh does not register classes whose name starts with an underscore in the browser.
class TourCard(JSComponent):
    """The card in the browser; it sends "back", "next", "act" and "stop"."""

    steps = param.List(default=[asdict(step) for step in STEPS])
    step = param.Integer(default=0, bounds=(0, len(STEPS) - 1))
    running = param.Boolean(default=False)

    _esm = _CARD


class Tour:
    """Shows `STEPS` one after another; Escape or the last button ends the tour.

    Parameters
    ----------
    on_act
        Called with what the step in view offers to show.
    """

    def __init__(self, on_act: Callable[[Act], None]) -> None:
        self._on_act = on_act
        self._card = TourCard(width=0, height=0, margin=0, styles={"position": "absolute"}, stylesheets=[_STYLE])
        self._card.on_msg(lambda event: self._receive(event.data))

    def layout(self) -> pn.viewable.Viewable:
        """The card, at the bottom of the window wherever it stands on the page."""
        return self._card

    @property
    def running(self) -> bool:
        """Whether the card is open."""
        return bool(self._card.running)

    @property
    def step(self) -> Step:
        """The step that is shown."""
        return STEPS[self._card.step]

    def start(self) -> None:
        """Open the card at the first step."""
        self._card.param.update(step=0, running=True)

    def stop(self) -> None:
        """Close the card."""
        self._card.running = False

    def next(self) -> None:
        """Go to the next step; after the last one the tour ends."""
        if self.step is STEPS[-1]:
            self.stop()
        else:
            self._card.step += 1

    def back(self) -> None:
        """Go to the previous step, if there is one."""
        self._card.step = max(self._card.step - 1, 0)

    def _receive(self, message: Any) -> None:
        match message:
            case "back":
                self.back()
            case "next":
                self.next()
            case "act" if self.step.act is not None:
                self._on_act(self.step.act)
            case "stop":
                self.stop()
