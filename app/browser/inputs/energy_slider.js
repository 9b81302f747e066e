// @ts-check
import {hear, tell} from "../modules/energy_events.js"
import {CountedValue} from "./counted_value.js"

/**
 * The slider of the energy. While it moves, it sends the energy to the page. Released, it sends the energy to the server.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const label = document.createElement("label")
  const [name, number] = [document.createElement("span"), document.createElement("output")]
  const rail = document.createElement("input")
  el.classList.add("energy-slider")
  rail.type = "range"
  rail.step = "any"
  label.htmlFor = rail.id = "energy"
  label.append(name, number)
  el.append(label, rail)
  const rounded = (/** @type {number} */ energy) => Number(energy.toFixed(Math.max(model.decimals, 0)))
  const clamped = (/** @type {number} */ energy) => Math.min(Math.max(energy, model.low), model.high)
  const write = (/** @type {number} */ energy) => {
    rail.value = String(energy)
    const decimals = Number(energy.toFixed(12)).toString().split(".")[1]?.length ?? 0
    number.textContent = energy.toFixed(Math.min(Math.max(decimals, model.decimals, 0), 12))
    rail.setAttribute("aria-valuetext", number.textContent)
  }
  // An energy beyond an end of the slider stays until the user moves the thumb.
  const value = new CountedValue(
    model,
    () => rounded(rail.valueAsNumber),
    energy => write(clamped(energy)),
  )
  const follow = () => {
    rail.min = String(model.low)
    rail.max = String(model.high)
    rail.disabled = model.disabled
    rail.setAttribute("aria-label", model.label)
    name.textContent = model.note || `${model.label}: `
    number.hidden = model.note !== ""
    value.follow()
  }
  const drag = (/** @type {number} */ energy) => {
    name.textContent = `${model.label}: `
    number.hidden = false
    write(energy)
    value.begin()
    for (const event of ["energydragged", "energyshown"]) tell(event, energy)
  }
  // A drag that ends at the energy where it began fires no change event.
  const release = () => {
    if (value.done) return
    const energy = value.read()
    tell("energyreleased", energy)
    if (energy === clamped(model.shown.value)) value.cancel()
    else value.finish()
  }
  // A key changes the last decimal. The browser itself would use steps of a hundredth of the range.
  const press = (/** @type {KeyboardEvent} */ event) => {
    const direction = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1}[event.key]
    if (!direction) return
    event.preventDefault()
    drag(clamped(rounded(rail.valueAsNumber + direction * 10 ** -model.decimals)))
    release()
  }
  rail.addEventListener("input", () => drag(value.read()))
  for (const event of ["change", "pointerup", "pointercancel"]) rail.addEventListener(event, release)
  rail.addEventListener("keydown", press)
  const show = (/** @type {number} */ energy) => write(clamped(energy))
  model.on("lifecycle:remove", hear("energyshown", show))
  // The engine may be loaded while the user holds the slider.
  const answer = () => value.unsent && tell("energydragged", value.read())
  model.on("lifecycle:remove", hear("energyasked", answer))
  model.on(["low", "high", "decimals", "label", "note", "disabled", "shown"], follow)
  follow()
}
