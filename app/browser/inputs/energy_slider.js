// @ts-check
import {dispatch, listen} from "../modules/energy_events.js"
import {CountedValue} from "./counted_value.js"

/** Largest number of decimals of a shown energy. */
const MOST_DECIMALS = 12

/**
 * The slider of the energy. While it moves, other parts of the page receive its energy. When it is released, the server does.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const label = document.createElement("label")
  const [name, number] = [document.createElement("span"), document.createElement("output")]
  const slider = document.createElement("input")
  el.classList.add("energy-slider")
  slider.type = "range"
  slider.step = "any"
  label.htmlFor = slider.id = "energy"
  label.append(name, number)
  el.append(label, slider)
  const rounded = (/** @type {number} */ energy) => Number(energy.toFixed(Math.max(model.decimals, 0)))
  const clamped = (/** @type {number} */ energy) => Math.min(Math.max(energy, model.low), model.high)
  const write = (/** @type {number} */ energy) => {
    slider.value = String(energy)
    const decimals = Number(energy.toFixed(MOST_DECIMALS)).toString().split(".")[1]?.length ?? 0
    number.textContent = energy.toFixed(Math.min(Math.max(decimals, model.decimals, 0), MOST_DECIMALS))
    slider.setAttribute("aria-valuetext", number.textContent)
  }
  // An energy beyond an end of the slider stays until the user moves the thumb.
  const value = new CountedValue(
    model,
    () => rounded(slider.valueAsNumber),
    energy => write(clamped(energy)),
  )
  const follow = () => {
    slider.min = String(model.low)
    slider.max = String(model.high)
    slider.disabled = model.disabled
    slider.setAttribute("aria-label", model.label)
    name.textContent = model.note || `${model.label}: `
    number.hidden = model.note !== ""
    value.follow()
  }
  const drag = (/** @type {number} */ energy) => {
    name.textContent = `${model.label}: `
    number.hidden = false
    write(energy)
    value.begin()
    for (const event of ["energydragged", "energyshown"]) dispatch(event, energy)
  }
  // A drag that ends at the energy where it began fires no change event.
  const release = () => {
    if (value.isFinal) return
    const energy = value.read()
    dispatch("energyreleased", energy)
    if (energy === clamped(model.shown.value)) value.cancel()
    else value.finish()
  }
  // A key changes the last decimal. The browser itself would use steps of a hundredth of the range.
  const press = (/** @type {KeyboardEvent} */ event) => {
    const direction = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1}[event.key]
    if (!direction) return
    event.preventDefault()
    drag(clamped(rounded(slider.valueAsNumber + direction * 10 ** -model.decimals)))
    release()
  }
  slider.addEventListener("input", () => drag(value.read()))
  for (const event of ["change", "pointerup", "pointercancel"]) slider.addEventListener(event, release)
  slider.addEventListener("keydown", press)
  const show = (/** @type {number} */ energy) => write(clamped(energy))
  model.on("lifecycle:remove", listen("energyshown", show))
  // The engine may be loaded while the user holds the slider.
  const answer = () => value.isUnsent && dispatch("energydragged", value.read())
  model.on("lifecycle:remove", listen("energyasked", answer))
  model.on(["low", "high", "decimals", "label", "note", "disabled", "shown"], follow)
  follow()
}
