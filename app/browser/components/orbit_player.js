// @ts-check
import {number} from "../../../plots/browser/modules/numbers.js"

/**
 * A button and a slider for the time along the orbits. The steps from `begin` to `end` are played in a loop, and each is sent.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const [button, slider, text] = [
    document.createElement("button"),
    document.createElement("input"),
    document.createElement("output"),
  ]
  el.classList.add("orbit-player")
  el.append(button, slider, text)
  button.type = "button"
  Object.assign(slider, {type: "range", min: 0, max: model.steps, step: 1})
  slider.setAttribute("aria-label", model.label)
  /** @type {number | undefined} */
  let timer
  const write = (/** @type {number} */ step) => {
    const time = model.begin + ((model.end - model.begin) * step) / model.steps
    slider.valueAsNumber = step
    text.textContent = `t = ${number(time, 5)}`
    slider.setAttribute("aria-valuetext", text.textContent)
  }
  const goTo = (/** @type {number} */ step) => {
    write(step)
    model.send_msg({step: slider.valueAsNumber, begin: model.begin, end: model.end})
  }
  const setPlaying = (/** @type {boolean} */ isPlaying) => {
    clearInterval(timer)
    timer = isPlaying ? window.setInterval(() => goTo((slider.valueAsNumber + 1) % (model.steps + 1)), model.pause) : undefined
    button.className = isPlaying ? "pause" : "play"
    button.setAttribute("aria-label", isPlaying ? "Pause the orbits" : "Play the orbits")
  }
  // Show the beginning of another interval. A running animation continues from there.
  const follow = () => {
    const isEmpty = model.begin === model.end
    for (const input of [button, slider]) input.disabled = isEmpty
    if (isEmpty) setPlaying(false)
    write(0)
  }
  button.addEventListener("click", () => setPlaying(timer === undefined))
  slider.addEventListener("input", () => goTo(slider.valueAsNumber))
  model.on(["begin", "end"], follow)
  model.on("lifecycle:remove", () => clearInterval(timer))
  setPlaying(false)
  follow()
  // A player that is shown again is at the beginning, which the server does not know yet.
  if (!slider.disabled) goTo(0)
}
