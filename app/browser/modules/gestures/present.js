// @ts-check
/**
 * What the page shows now, which `main.js` sets for modules that are loaded later.
 *
 * @typedef {object} Shown
 * @property {import("../../../../plots/browser/modules/engine/system.js").System} system
 * @property {import("../../../../plots/browser/modules/engine/integrator.js").Modules} modules
 * @property {() => import("../../../../plots/browser/modules/workers/frames.js").Scene | null} scene  slice, energy and window; null if not computable here
 * @property {() => string[]} colours  of the outcomes, exits first
 * @property {() => string[]} labels  of the outcomes
 * @property {HTMLElement} host  for canvases over the pictures
 */

/** @type {Shown | null} */
let shown = null
/** @type {Set<() => void>} */
const listeners = new Set()

/** What the page shows; null while its system is not loaded. @returns {Shown | null} */
export const present = () => shown

/**
 * Set what the page shows.
 *
 * @param {Shown | null} next
 */
export function setPresent(next) {
  shown = next
  for (const listener of listeners) listener()
}

/**
 * Call a function whenever the page shows something else; return a function that ends the calls.
 *
 * @param {() => void} listener
 */
export function onPresent(listener) {
  listeners.add(listener)
  return () => void listeners.delete(listener)
}
