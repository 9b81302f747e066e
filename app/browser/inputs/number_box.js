// @ts-check
import {SharedValue} from "../modules/counted_value.js"
import {storeOf} from "../modules/view_store.js"

/**
 * A box for a number, which is sent when the box loses focus or Enter is pressed. A box without a number of its own has the energy.
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
  const value = model.shown ? new SharedValue(model) : storeOf(model.document).energy
  let isTyped = false
  const follow = () => {
    input.step = model.step
    input.disabled = model.disabled
    if (isTyped) return
    // A number that the server has not received yet is shown without the rounding errors in its last digits.
    const text = String(value.isUnsent ? Number(value.value.toPrecision(10)) : value.value)
    if (text === input.value) return
    input.value = text
    // Otherwise a visitor who has selected the previous number, to type another, would type behind the new number.
    if (input.matches(":focus")) input.select()
  }
  const finish = () => {
    if (!isTyped) return
    isTyped = false
    if (input.value === "") return follow()
    value.hold(input.valueAsNumber)
    value.finish()
  }
  input.addEventListener("input", () => (isTyped = true))
  input.addEventListener("change", finish)
  input.addEventListener("blur", finish)
  // Enter without a change of the number fires no change event.
  input.addEventListener("keydown", event => event.key === "Enter" && finish())
  if (model.shown) model.on("shown", () => value.follow())
  model.on("lifecycle:remove", value.listen(follow))
  model.on(["step", "disabled"], follow)
  follow()
}
