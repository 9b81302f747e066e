// @ts-check
import {CountedValue} from "../modules/counted_value.js"
import {paintShares} from "../modules/painting/share_columns.js"
import {VIEW_REST_MS, storeOf} from "../modules/view_store.js"

/**
 * A slider: the name and label of its parameter, its ends, the legal numbers of its box, and the shown number, with the count of
 * numbers that the server had received from this slider when it set this number.
 *
 * @typedef {{name: string, label: string, low: number, high: number, lowest: number, highest: number, value: number,
 *   count: number}} Row
 *
 * The picture on one of the sliders: the name of its parameter, a text about it, its columns, and the number of views before.
 *
 * @typedef {{name: string, title: string, count: number,
 *   columns: [number, import("../modules/painting/share_columns.js").Stack][]}} Strip
 */

/**
 * Sliders of parameters, each with a box for its number, which may lie beyond the ends of the slider. Each number is sent. A
 * number is final when the slider is released, when the slider or the box loses focus, or when Enter is pressed in the box.
 * When the view has been at rest for a while, {rest: count} asks for the picture on one of the sliders.
 *
 * @param {{model: any, el: HTMLElement}} component
 */
export function render({model, el}) {
  /** @type {Map<string, SliderRow>} */
  const shown = new Map()
  const paint = () => {
    for (const row of shown.values()) row.paint(model.strip)
  }
  const show = () => {
    /** @type {Row[]} */
    const rows = model.rows
    const names = new Set(rows.map(row => row.name))
    for (const [name, row] of shown) {
      if (names.has(name)) continue
      row.element.remove()
      shown.delete(name)
    }
    rows.forEach((row, place) => {
      const made = shown.get(row.name) ?? new SliderRow(model, row)
      shown.set(row.name, made)
      // Moving an element would take the focus from it.
      if (el.children[place] !== made.element) el.insertBefore(made.element, el.children[place] ?? null)
      made.follow(row)
    })
    paint()
  }
  model.on("rows", show)
  model.on("strip", paint)
  new ResizeObserver(paint).observe(el)
  show()
  askAtRest(model)
}

/** Ask for the picture of each view once, after a time without changes. @param {any} model  of the component */
function askAtRest(model) {
  const {energy, window: shared} = storeOf(model.document)
  let askedFor = -1
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let rest
  const wait = () => {
    clearTimeout(rest)
    const {count} = model.strip
    if (count === askedFor) return
    rest = setTimeout(() => {
      askedFor = count
      model.send_msg({rest: count})
    }, VIEW_REST_MS)
  }
  model.on("strip", wait)
  const ends = [energy, shared].map(value => value.listen(wait))
  model.on("lifecycle:remove", () => [() => clearTimeout(rest), ...ends].forEach(end => end()))
  wait()
}

class SliderRow {
  /**
   * @param {any} model  of the component
   * @param {Row} row
   */
  constructor(model, row) {
    this.row = row
    this.element = document.createElement("div")
    this.label = document.createElement("label")
    this.rail = document.createElement("div")
    this.canvas = document.createElement("canvas")
    this.slider = document.createElement("input")
    this.box = document.createElement("input")
    this.element.className = "parameter-slider"
    this.rail.className = "rail"
    this.label.htmlFor = this.slider.id = `rail-${row.name}`
    Object.assign(this.slider, {type: "range", step: model.step})
    Object.assign(this.box, {type: "number", step: model.step, className: "bk-input"})
    this.rail.append(this.canvas, this.slider)
    this.element.append(this.label, this.rail, this.box)
    this.value = new CountedValue(
      this._channel(model),
      () => this.box.valueAsNumber,
      number => [this.slider, this.box].forEach(input => write(input, number)),
    )
    this._listen()
  }

  /**
   * Return the shown value of this slider, and the way to send another, for `CountedValue`.
   *
   * @param {any} model
   */
  _channel(model) {
    const slider = this
    return {
      get shown() {
        return slider.row
      },
      send_msg: (/** @type {object} */ message) => model.send_msg({name: slider.row.name, ...message}),
    }
  }

  _listen() {
    const {slider, box, value} = this
    slider.addEventListener("input", () => {
      write(box, slider.valueAsNumber)
      value.change()
    })
    box.addEventListener("input", () => {
      if (!this._isLegal()) return
      write(slider, box.valueAsNumber)
      value.change()
    })
    box.addEventListener("blur", () => {
      if (!this._isLegal()) box.valueAsNumber = this.row.value
    })
    for (const event of ["pointerup", "pointercancel", "blur"]) slider.addEventListener(event, () => value.finish())
    box.addEventListener("blur", () => value.finish())
    box.addEventListener("keydown", event => event.key === "Enter" && value.finish())
  }

  /** Whether the box has a legal number: while a number is typed, the text may not be a number yet. */
  _isLegal() {
    return Number.isFinite(this.box.valueAsNumber) && !this.box.validity.rangeUnderflow && !this.box.validity.rangeOverflow
  }

  /** @param {Row} row */
  follow(row) {
    this.row = row
    this.label.textContent = row.label
    this.box.setAttribute("aria-label", `${row.label}, number`)
    Object.assign(this.slider, {min: row.low, max: row.high})
    Object.assign(this.box, {min: row.lowest, max: row.highest})
    this.value.follow()
  }

  /** Paint the picture if it belongs to this slider. @param {Strip} strip */
  paint({name, title, columns}) {
    const isPictured = name === this.row.name
    this.slider.title = isPictured ? title : ""
    this.slider.toggleAttribute("data-pictured", isPictured)
    paintShares(this.canvas, isPictured ? columns : [])
  }
}

/**
 * Show a number, unless the input has it already: the text of a number that is being typed stays.
 *
 * @param {HTMLInputElement} input
 * @param {number} number
 */
function write(input, number) {
  if (input.valueAsNumber !== number) input.valueAsNumber = number
}
