// @ts-check
/**
 * A box for a number: each number that is typed is sent, and a number of the server does not replace one that is being typed.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  const [label, input] = [document.createElement("label"), document.createElement("input")]
  el.classList.add("number-box")
  label.htmlFor = input.id = "number"
  input.className = "bk-input"
  input.type = "number"
  el.append(label, input)
  // Numbers typed so far. A number of the server that does not count them all is older than the last one typed.
  let typed = model.shown.typed
  let typing = false
  const follow = () => {
    label.textContent = model.label
    input.step = model.step
    input.disabled = model.disabled
    if (!typing && model.shown.typed >= typed) input.value = model.shown.number
  }
  const commit = () => {
    if (!typing) return
    typing = false
    if (input.value === "") follow()
    else model.send_msg({number: input.valueAsNumber, typed: ++typed})
  }
  input.addEventListener("input", () => (typing = true))
  input.addEventListener("change", commit)
  input.addEventListener("blur", commit)
  // Enter after the number that was there before is no change.
  input.addEventListener("keydown", event => event.key === "Enter" && commit())
  // The page shows another number, which the server has not received yet.
  const show = (/** @type {any} */ event) => {
    if (!typing) input.value = String(Number(event.detail.toPrecision(10)))
  }
  if (model.shown_event) document.addEventListener(model.shown_event, show)
  model.on("lifecycle:remove", () => document.removeEventListener(model.shown_event, show))
  model.on(["label", "step", "disabled", "shown"], follow)
  follow()
}
