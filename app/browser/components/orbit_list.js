// @ts-check
/**
 * The numbers of the orbits in a line, as radio buttons in the colours of the orbits.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  el.className = "orbit-numbers"
  el.setAttribute("role", "radiogroup")
  el.setAttribute("aria-label", model.label)
  const add_row = () => {
    const [row, radio] = [document.createElement("label"), document.createElement("input")]
    const place = el.children.length
    Object.assign(radio, {type: "radio", name: "orbit"})
    radio.addEventListener("change", () => model.send_msg({chosen: place}))
    row.style.setProperty("--orbit", `var(--orbit-${place + 1})`)
    row.append(radio, document.createElement("span"))
    el.append(row)
  }
  const follow = () => {
    while (el.children.length > model.rows.length) el.lastElementChild?.remove()
    while (el.children.length < model.rows.length) add_row()
    for (const [place, text] of model.rows.entries()) {
      const row = /** @type {HTMLElement} */ (el.children[place])
      const [radio, label] = /** @type {any} */ (row.children)
      radio.checked = place === model.chosen
      radio.setAttribute("aria-label", text)
      row.title = text
      label.textContent = String(place + 1)
    }
  }
  model.on(["rows", "chosen"], follow)
  follow()
}
