// @ts-check
/**
 * Events of the document about energy and window, which the slider, its box, the engine and the section exchange without the server:
 *
 * - `energydragged`: the user moves the slider to an energy;
 * - `energyreleased`: the user has released the slider;
 * - `energyshown`: the pictures show an energy, during a drag or while the energy is played;
 * - `sceneshown`: the pictures show another energy or window, or will in the next frame;
 * - `energyasked`: the engine has started, and asks for the energy of a slider that the user holds.
 */

/**
 * Send an event to all parts of the page.
 *
 * @param {string} event
 * @param {number} [energy]
 */
export function dispatch(event, energy) {
  document.dispatchEvent(new CustomEvent(event, {detail: energy}))
}

/**
 * Call a function with the energy of each event of a name. Return a function that ends this.
 *
 * @param {string} event
 * @param {(energy: number) => void} take
 */
export function listen(event, take) {
  const listener = (/** @type {Event} */ each) => take(/** @type {CustomEvent} */ (each).detail)
  document.addEventListener(event, listener)
  return () => document.removeEventListener(event, listener)
}
