// @ts-check
/**
 * What the page shows now, for modules that are loaded later; `main.js` writes it.
 *
 * @typedef {object} Shown
 * @property {import("../engine/system.js").System} system
 * @property {import("../engine/integrator.js").Modules} modules
 * @property {() => import("../workers/frames.js").Scene | null} scene  slice, energy and window in view; null if the browser cannot compute it
 * @property {() => string[]} colours  of the outcomes, exits first
 * @property {() => string[]} labels  of the outcomes
 * @property {HTMLElement} host  for canvases over the pictures
 */

/** @type {Shown | null} */
let shown = null
/** @type {Set<() => void>} */
const listeners = new Set()

/** @returns {Shown | null} */
export const present = () => shown

/**
 * Say that the page shows something else: another system, or another view of it.
 *
 * @param {Shown | null} next
 */
export function setPresent(next) {
  shown = next
  for (const listener of listeners) listener()
}

/**
 * Call a function when the page shows something else; returns a function that ends this.
 *
 * @param {() => void} listener
 */
export function onPresent(listener) {
  listeners.add(listener)
  return () => void listeners.delete(listener)
}
