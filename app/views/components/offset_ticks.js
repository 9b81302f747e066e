// @ts-check
/** Labels of an axis whose plain numbers would be too long. */

/** Number of steps of a label in its unit. Differences of close numbers are not more exact. */
const STEPS = 100

/**
 * Write the distance of a tick from a base. A note below the picture states the base.
 *
 * @param {number} tick
 * @param {number} base
 * @param {number} unit  of the distance
 */
export function offsetLabel(tick, base, unit) {
  return String(Math.round(((tick - base) / unit) * STEPS) / STEPS).replace("-", "−")
}
