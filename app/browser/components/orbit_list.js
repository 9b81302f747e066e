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
  const addRow = () => {
    const [row, radio] = [document.createElement("label"), document.createElement("input")]
    const index = el.children.length
    Object.assign(radio, {type: "radio", name: "orbit"})
    radio.addEventListener("change", () => model.send_msg({chosen: index}))
    row.style.setProperty("--orbit", `var(--orbit-${index + 1})`)
    row.append(radio, document.createElement("span"))
    el.append(row)
  }
  const follow = () => {
    while (el.children.length > model.rows.length) el.lastElementChild?.remove()
    while (el.children.length < model.rows.length) addRow()
    for (const [index, text] of model.rows.entries()) {
      const row = /** @type {HTMLElement} */ (el.children[index])
      const [radio, label] = /** @type {any} */ (row.children)
      radio.checked = index === model.chosen
      radio.setAttribute("aria-label", text)
      row.title = text
      label.textContent = String(index + 1)
    }
  }
  model.on(["rows", "chosen"], follow)
  follow()
}
