// @ts-check
import {CountedValue} from "../modules/counted_value.js"

/**
 * A box for a formula, as high as its text. Each change is sent. The text is final when Enter is pressed or the box
 * loses focus.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const label = document.createElement("label")
  const box = document.createElement("textarea")
  el.classList.add("formula-box")
  label.htmlFor = box.id = "formula"
  label.textContent = model.label
  Object.assign(box, {
    className: "bk-input",
    rows: 1,
    maxLength: model.longest,
    placeholder: model.placeholder,
    spellcheck: false,
  })
  el.append(label, box)
  const write = (/** @type {string} */ text) => {
    if (box.value !== text) box.value = text
  }
  const value = new CountedValue(model, () => box.value, write)
  box.addEventListener("input", () => value.change())
  box.addEventListener("blur", () => value.finish())
  box.addEventListener("keydown", event => {
    if (event.key !== "Enter" || event.isComposing) return
    event.preventDefault()
    value.finish()
  })
  // The box takes the focus when it is shown, but not on a touch screen, where the keyboard would cover the page.
  model.on("lifecycle:after_render", () => {
    if (matchMedia("(pointer: fine)").matches) box.focus({preventScroll: true})
  })
  model.on("shown", () => value.follow())
  value.follow()
}
