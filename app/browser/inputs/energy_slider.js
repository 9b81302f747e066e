// @ts-check
import {storeOf} from "../modules/view_store.js"

/** Largest number of decimals of a shown energy. */
const MOST_DECIMALS = 12

/**
 * The slider of the energy, with marks, before a canvas for `modules/gestures/share_strip.js`. While it moves, only the other parts of the page receive its energy; when it is released, the server does.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const [head, rail, marks] = ["div", "div", "div"].map(tag => document.createElement(tag))
  const [label, legend] = [document.createElement("label"), document.createElement("small")]
  const [name, number] = [document.createElement("span"), document.createElement("output")]
  const [canvas, slider] = [document.createElement("canvas"), document.createElement("input")]
  el.classList.add("energy-slider")
  head.className = "head"
  rail.className = "rail"
  slider.type = "range"
  slider.step = "any"
  label.htmlFor = slider.id = "energy"
  label.append(name, number)
  head.append(label, legend)
  rail.append(canvas, marks, slider)
  el.append(head, rail)
  const store = storeOf(model.document)
  store.rail = {slider, canvas}
  const {energy} = store
  const rounded = (/** @type {number} */ value) => Number(value.toFixed(Math.max(model.decimals, 0)))
  // An energy beyond an end of the slider stays until the user moves the thumb.
  const clamped = (/** @type {number} */ value) => Math.min(Math.max(value, model.low), model.high)
  const follow = () => {
    slider.min = String(model.low)
    slider.max = String(model.high)
    slider.disabled = model.disabled
    slider.setAttribute("aria-label", model.label)
    const note = energy.isUnsent ? "" : model.note
    name.textContent = note || `${model.label}: `
    number.hidden = note !== ""
    const value = clamped(energy.value)
    slider.value = String(value)
    const decimals = Number(value.toFixed(MOST_DECIMALS)).toString().split(".")[1]?.length ?? 0
    number.textContent = value.toFixed(Math.min(Math.max(decimals, model.decimals, 0), MOST_DECIMALS))
    slider.setAttribute("aria-valuetext", number.textContent)
  }
  const mark = () => {
    marks.replaceChildren(...marksOf("opening", model.openings), ...marksOf("marked", model.marked))
    legend.textContent = model.legend
  }
  /** Return marks at those of some energies that are on the slider. @param {string} kind @param {number[]} energies */
  const marksOf = (kind, energies) =>
    energies
      .map(value => (value - model.low) / (model.high - model.low))
      .filter(share => share >= 0 && share <= 1)
      .map(share => {
        const element = document.createElement("i")
        element.className = kind
        element.style.left = `${100 * share}%`
        return element
      })
  // A drag that ends at the energy where it began fires no change event.
  const release = () => {
    if (energy.isFinal) return
    if (energy.value === clamped(energy.model.shown.value)) energy.cancel()
    else energy.finish()
  }
  // A key changes the last decimal. The browser itself would use steps of a hundredth of the range.
  const press = (/** @type {KeyboardEvent} */ event) => {
    const direction = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1}[event.key]
    if (!direction) return
    event.preventDefault()
    energy.hold(clamped(rounded(slider.valueAsNumber + direction * 10 ** -model.decimals)))
    release()
  }
  slider.addEventListener("input", () => energy.hold(rounded(slider.valueAsNumber)))
  for (const event of ["change", "pointerup", "pointercancel"]) slider.addEventListener(event, release)
  slider.addEventListener("keydown", press)
  model.on("lifecycle:remove", energy.listen(follow))
  model.on(["low", "high", "decimals", "label", "note", "disabled"], follow)
  model.on(["low", "high", "openings", "marked", "legend"], mark)
  mark()
  follow()
}
