"""Widgets that do not contradict the server with what it has told them itself.

Panel's widgets in React send back every value that they have drawn. One that the server overrules between the drawing and the
sending comes back as if the visitor had chosen it, and the widget and the server then believe it: a button that the server
enabled 10 ms after it had disabled it stays disabled.
"""

from __future__ import annotations

import panel as pn
from panel.custom import JSComponent

_FILTER = """
// Longer than a busy page takes to draw, shorter than a visitor takes to answer.
const LATE_MS = 500
const REACT = "panel.models.esm.ReactComponent"

// Of each widget's data by name: what the server said last, if nobody has changed it since, and what it said before that.
const memory = new WeakMap()

function memory_of(model) {
  // What is not on the page yet cannot be told from what is no widget's.
  if (!model.document) return null
  if (!memory.has(model)) {
    const of_react = [...model.document._all_models.values()].some(one => one.type === REACT && one.data === model)
    memory.set(model, of_react ? new Map() : null)
  }
  return memory.get(model)
}

const is_late = (record, value, now) => record.overruled.some(one => one.value === value && now - one.since < LATE_MS)

function hear(said, name, value, now) {
  const {latest, overruled} = said.get(name) ?? {overruled: []}
  const kept = overruled.filter(one => now - one.since < LATE_MS && one.value !== value)
  if (latest && latest.value !== value) kept.push({value: latest.value, since: now})
  said.set(name, {latest: {value}, overruled: kept})
}

function is_echo(said, model, name, value, now) {
  const record = said.get(name)
  if (!record || model[name] === value) return false
  if (record.latest && is_late(record, value, now)) return true
  record.latest = null
  return false
}

function drop_echoes(HasProps) {
  const set = HasProps.prototype.setv
  HasProps.prototype.setv = function(changes, options = {}) {
    const said = memory_of(this)
    if (!said) return set.call(this, changes, options)
    const now = performance.now()
    if (options.sync === false) {
      for (const [name, value] of Object.entries(changes)) hear(said, name, value, now)
      return set.call(this, changes, options)
    }
    const meant = Object.entries(changes).filter(([name, value]) => !is_echo(said, this, name, value, now))
    return set.call(this, Object.fromEntries(meant), options)
  }
}

export function render({el}) {
  el.setAttribute("aria-hidden", "true")
  if (window.drops_echoes) return
  window.drops_echoes = true
  drop_echoes(Bokeh.require("core/has_props").HasProps)
}
"""


# Its name has no underscore in front: Bokeh tells the browser of no such model.
class EchoFilter(JSComponent):
    """The part in the browser."""

    _esm = _FILTER


def echo_filter() -> pn.viewable.Viewable:
    """What must be on a page once, for all its widgets; there is nothing to see of it."""
    return EchoFilter(width=0, height=0, margin=0, styles={"position": "absolute"})
