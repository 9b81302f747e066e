// @ts-check
/**
 * A box for a formula, as high as its text. Each change is sent; Enter, or leaving the box, finishes the text.
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
  // Texts typed so far. A text of the server that does not count them all is older than the last one typed.
  let typed = model.shown.typed
  let done = true
  const send = () => model.send_msg({text: box.value, typed: ++typed, done})
  const follow = () => {
    if (model.shown.typed >= typed && box.value !== model.shown.text) box.value = model.shown.text
  }
  const finish = () => {
    if (done) return
    done = true
    send()
  }
  box.addEventListener("input", () => {
    done = false
    send()
  })
  box.addEventListener("blur", finish)
  box.addEventListener("keydown", event => {
    if (event.key !== "Enter" || event.isComposing) return
    event.preventDefault()
    finish()
  })
  // The box is shown for typing; on a touch screen, its keyboard would cover the page.
  model.on("lifecycle:after_render", () => {
    if (matchMedia("(pointer: fine)").matches) box.focus({preventScroll: true})
  })
  model.on("shown", follow)
  follow()
}
