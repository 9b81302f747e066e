// @ts-check
import {number} from "../modules/numbers.js"

/**
 * A button and a slider for the time along the orbits. Steps from `begin` to `end` are played in a loop, and each step is sent.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const [button, rail, text] = [
    document.createElement("button"),
    document.createElement("input"),
    document.createElement("output"),
  ]
  el.classList.add("orbit-player")
  el.append(button, rail, text)
  button.type = "button"
  Object.assign(rail, {type: "range", min: 0, max: model.steps, step: 1})
  rail.setAttribute("aria-label", model.label)
  /** @type {number | undefined} */
  let timer
  const write = (/** @type {number} */ step) => {
    const time = model.begin + ((model.end - model.begin) * step) / model.steps
    rail.valueAsNumber = step
    text.textContent = `t = ${number(time, 5)}`
    rail.setAttribute("aria-valuetext", text.textContent)
  }
  const go = (/** @type {number} */ step) => {
    write(step)
    model.send_msg({step: rail.valueAsNumber, begin: model.begin, end: model.end})
  }
  const play = (/** @type {boolean} */ on) => {
    clearInterval(timer)
    timer = on ? window.setInterval(() => go((rail.valueAsNumber + 1) % (model.steps + 1)), model.pause) : undefined
    button.className = on ? "pause" : "play"
    button.setAttribute("aria-label", on ? "Pause the orbits" : "Play the orbits")
  }
  // Go to the beginning of another interval, and continue to play.
  const follow = () => {
    const isEmpty = model.begin === model.end
    for (const input of [button, rail]) input.disabled = isEmpty
    if (isEmpty) play(false)
    write(0)
  }
  button.addEventListener("click", () => play(timer === undefined))
  rail.addEventListener("input", () => go(rail.valueAsNumber))
  model.on(["begin", "end"], follow)
  model.on("lifecycle:remove", () => clearInterval(timer))
  play(false)
  follow()
  // A player that returns to the page is at the beginning.
  if (!rail.disabled) go(0)
}
