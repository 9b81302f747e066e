// @ts-check
import {listen} from "../modules/energy_events.js"
import {CountedValue} from "./counted_value.js"

/**
 * A box for a number, which is sent when the box loses focus or Enter is pressed.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const [label, input] = [document.createElement("label"), document.createElement("input")]
  el.classList.add("number-box")
  label.htmlFor = input.id = "number"
  label.textContent = model.label
  input.className = "bk-input"
  input.type = "number"
  el.append(label, input)
  const write = (/** @type {number} */ number) => (input.value = String(number))
  const value = new CountedValue(model, () => input.valueAsNumber, write)
  const follow = () => {
    input.step = model.step
    input.disabled = model.disabled
    value.follow()
  }
  const finish = () => {
    if (input.value === "") value.cancel()
    else value.finish()
  }
  input.addEventListener("input", () => value.begin())
  input.addEventListener("change", finish)
  input.addEventListener("blur", finish)
  // Enter without a change of the number fires no change event.
  input.addEventListener("keydown", event => event.key === "Enter" && finish())
  // Show a number that the server has not received yet, without the rounding errors in its last digits.
  const show = (/** @type {number} */ number) => !value.isUnsent && write(Number(number.toPrecision(10)))
  if (model.shown_event) model.on("lifecycle:remove", listen(model.shown_event, show))
  model.on(["step", "disabled", "shown"], follow)
  follow()
}
