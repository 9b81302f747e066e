// @ts-check
import {CountedValue} from "./counted_value.js"

/**
 * A slider with a box for its number, which may lie beyond the ends of the slider. Each number is sent. A number is final when
 * the slider is released, when the slider or the box loses focus, or when Enter is pressed in the box.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const label = document.createElement("label")
  const [slider, box] = [document.createElement("input"), document.createElement("input")]
  el.classList.add("parameter-slider")
  label.htmlFor = slider.id = "rail"
  Object.assign(slider, {type: "range", step: model.step})
  Object.assign(box, {type: "number", min: model.lowest, max: model.highest, step: model.step, className: "bk-input"})
  el.append(label, slider, box)
  const write = (/** @type {HTMLInputElement} */ input, /** @type {number} */ number) => {
    if (input.valueAsNumber !== number) input.valueAsNumber = number
  }
  const writeBoth = (/** @type {number} */ number) => [slider, box].forEach(input => write(input, number))
  const value = new CountedValue(model, () => box.valueAsNumber, writeBoth)
  // While a number is typed, the text may not be a number yet.
  const isLegal = () => Number.isFinite(box.valueAsNumber) && !box.validity.rangeUnderflow && !box.validity.rangeOverflow
  slider.addEventListener("input", () => {
    write(box, slider.valueAsNumber)
    value.change()
  })
  box.addEventListener("input", () => {
    if (!isLegal()) return
    write(slider, box.valueAsNumber)
    value.change()
  })
  box.addEventListener("blur", () => {
    if (!isLegal()) box.valueAsNumber = model.shown.value
  })
  for (const event of ["pointerup", "pointercancel", "blur"]) slider.addEventListener(event, () => value.finish())
  box.addEventListener("blur", () => value.finish())
  box.addEventListener("keydown", event => event.key === "Enter" && value.finish())
  const show = () => {
    label.textContent = model.label
    box.setAttribute("aria-label", `${model.label}, number`)
    Object.assign(slider, {min: model.low, max: model.high})
    value.follow()
  }
  for (const name of ["label", "low", "high", "shown"]) model.on(name, show)
  show()
}
