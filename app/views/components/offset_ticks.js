// @ts-check
/** Labels of an axis whose plain numbers would be too long. */

/** Parts of a unit that are shown: differences of close numbers are not more exact than that. */
const PARTS = 100

/**
 * The distance of a tick from a number that the page states.
 *
 * @param {number} tick
 * @param {number} base
 * @param {number} unit  of the distance
 */
export function offsetLabel(tick, base, unit) {
  return String(Math.round(((tick - base) / unit) * PARTS) / PARTS).replace("-", "−")
}
