// @ts-check
/**
 * A slider with a box for its number, which may lie beyond the ends of the slider. Each number is sent; letting go of the slider,
 * leaving it, or Enter says that the number is done.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const label = document.createElement("label")
  const [rail, box] = [document.createElement("input"), document.createElement("input")]
  el.classList.add("parameter-slider")
  label.htmlFor = rail.id = "rail"
  label.textContent = model.label
  Object.assign(rail, {type: "range", min: model.low, max: model.high, step: model.step})
  Object.assign(box, {type: "number", min: model.lowest, max: model.highest, step: model.step, className: "bk-input"})
  box.setAttribute("aria-label", `${model.label}, number`)
  el.append(label, rail, box)
  // Numbers chosen so far. A number of the server that does not count them all is older than the last one.
  let chosen = model.shown.chosen
  let done = true
  const write = (/** @type {HTMLInputElement} */ input, /** @type {number} */ number) => {
    if (input.valueAsNumber !== number) input.valueAsNumber = number
    const {low, high} = model
    const share = Math.min(Math.max((number - low) / (high - low), 0), 1)
    rail.style.setProperty("--share", String(share))
  }
  const follow = () => {
    if (model.shown.chosen < chosen) return
    for (const input of [rail, box]) write(input, model.shown.number)
  }
  const send = () => model.send_msg({number: box.valueAsNumber, chosen: ++chosen, done})
  const choose = () => {
    done = false
    send()
  }
  const finish = () => {
    if (done) return
    done = true
    send()
  }
  // A number that is being typed may not be one yet.
  const is_legal = () => Number.isFinite(box.valueAsNumber) && !box.validity.rangeUnderflow && !box.validity.rangeOverflow
  rail.addEventListener("input", () => {
    write(box, rail.valueAsNumber)
    choose()
  })
  box.addEventListener("input", () => {
    if (!is_legal()) return
    write(rail, box.valueAsNumber)
    choose()
  })
  box.addEventListener("blur", () => {
    if (!is_legal()) box.valueAsNumber = model.shown.number
  })
  for (const event of ["pointerup", "pointercancel", "blur"]) rail.addEventListener(event, finish)
  box.addEventListener("blur", finish)
  box.addEventListener("keydown", event => event.key === "Enter" && finish())
  model.on("shown", follow)
  follow()
}
