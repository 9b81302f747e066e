"""A box for a number: each number that is typed arrives, and a number of the server does not replace one that is being typed."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import Any

import param
from panel.custom import JSComponent

_BOX = """
export function render({model, el}) {
  const label = document.createElement("label"), input = document.createElement("input")
  el.classList.add("number-box")
  label.htmlFor = input.id = "number"
  input.className = "bk-input"
  input.type = "number"
  el.append(label, input)
  // Numbers typed so far. A number of the server that does not count them all is older than the last one typed.
  let typed = model.shown.typed
  let typing = false
  const follow = () => {
    label.textContent = model.label
    input.step = model.step
    input.disabled = model.disabled
    if (!typing && model.shown.typed >= typed) input.value = model.shown.number
  }
  const commit = () => {
    if (!typing) return
    typing = false
    if (input.value === "") follow()
    else model.send_msg({number: input.valueAsNumber, typed: ++typed})
  }
  input.addEventListener("input", () => { typing = true })
  input.addEventListener("change", commit)
  input.addEventListener("blur", commit)
  // Enter after the number that was there before is no change.
  input.addEventListener("keydown", event => { if (event.key === "Enter") commit() })
  // The page shows another number, which the server does not know of yet.
  const show = event => { if (!typing) input.value = String(Number(event.detail.toPrecision(10))) }
  if (model.shown_event) document.addEventListener(model.shown_event, show)
  model.on("lifecycle:remove", () => document.removeEventListener(model.shown_event, show))
  model.on(["label", "step", "disabled", "shown"], follow)
  follow()
}
"""


class NumberBox(JSComponent):
    """A box for a number with a label.

    Boxes of Bokeh show each number of the server at once, also over a text that is being typed; and Panel drops a number that
    is typed while an earlier action, which sets another one, is still to be handled.

    Parameters
    ----------
    on_typed
        Called with each number that is typed, without the session's lock.
    number
        The number at first.
    **options
        Parameters of the component.
    """

    label = param.String()
    step = param.Number(default=0.1, doc="step of the arrow keys and buttons")
    disabled = param.Boolean()
    shown_event = param.String(doc="event of the page with a number to show that is not the server's")
    shown = param.Dict(default={}, doc="number, and how many typed ones the server knew of when it set this one")

    _esm = _BOX

    def __init__(self, on_typed: Callable[[float], None], number: float, **options: Any) -> None:
        super().__init__(shown={"number": number, "typed": 0}, **options)
        self._typed, self._on_typed = 0, on_typed
        self.on_msg(lambda event: self._receive(event.data))

    def show(self, number: float) -> None:
        """Show a number."""
        self.shown = {"number": number, "typed": self._typed}

    def _receive(self, message: Any) -> None:
        # Messages come from a browser: ignore what is not expected.
        match message:
            case {"number": float() | int() as number, "typed": int(typed)} if isfinite(number):
                self._typed = typed
                self._on_typed(float(number))
