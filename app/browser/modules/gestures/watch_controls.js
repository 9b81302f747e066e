// @ts-check
/** The controls of the player of many orbits, and the numbers that it writes. */

import {count as whole, number, percentWithDecimal} from "../../../../plots/browser/modules/numbers.js"

/** Number of steps of the slider of time. */
export const SLIDER_STEPS = 1000

/**
 * Return a new element.
 *
 * @type {(tag: string, attributes?: object, ...children: (Node | string)[]) => any}
 */
const makeElement = (tag, attributes = {}, ...children) => {
  const node = Object.assign(document.createElement(tag), attributes)
  node.append(...children)
  return node
}

/** Return the options of a list, given their texts by value. @type {(options: Record<string, string>) => HTMLElement[]} */
const makeOptions = options => Object.entries(options).map(([value, text]) => makeElement("option", {value}, text))

/** Return a button. @type {(text: string, kind?: string) => HTMLButtonElement} */
const makeButton = (text, kind = "") => makeElement("button", {type: "button", className: `bk-btn ${kind}`}, text)

/** @type {(...children: (Node | string)[]) => HTMLElement} */
const makeRow = (...children) => makeElement("div", {className: "row"}, ...children)

/**
 * Name an element that has no text.
 *
 * @template {HTMLElement} T
 * @param {T} element
 * @param {string} name
 */
const named = (element, name) => {
  element.setAttribute("aria-label", name)
  return element
}

/** Makes the elements of the player. */
export class WatchControls {
  where = named(makeElement("select", {className: "bk-input"}), "Starts")
  count = named(makeElement("select", {className: "bk-input"}), "Number of orbits")
  otherStarts = makeButton("Other starts")
  radius = named(makeElement("input", {type: "range", step: 0.5}), "Radius of the disc, as a power of ten of the window")
  radiusOutput = makeElement("output")
  play = makeButton("", "play")
  step = makeButton("Step")
  film = makeButton("● Film")
  close = named(makeButton("✕", "close"), "Close the player")
  time = named(makeElement("input", {type: "range", min: 0, max: SLIDER_STEPS, step: 1, value: 0}), "Time of the orbits")
  timeOutput = makeElement("output")
  pace = named(makeElement("select", {className: "bk-input"}), "Speed")
  trails = makeElement("input", {type: "checkbox"})
  loop = makeElement("input", {type: "checkbox"})
  note = makeElement("p", {className: "quiet"})
  counters = makeElement("table")
  growth = makeElement("p", {className: "quiet"})
  chart = makeElement("canvas", {className: "survival"})
  results = makeElement("div", {}, this.chart, this.counters, this.growth)
  /** The controls that a window in which the results are below the pictures shows beside these, while orbits are watched. */
  line = makeElement("div", {className: "row line"}, this.play, this.time, this.timeOutput, this.close)

  /**
   * @param {HTMLElement} el  element of the component
   * @param {{counts: number[], radii: [number, number]}} choices
   * @param {string[]} paces
   */
  constructor(el, {counts, radii}, paces) {
    const countTexts = counts.map(each => [each, `${each.toLocaleString("en").replaceAll(",", " ")} orbits`])
    this.count.replaceChildren(...makeOptions(Object.fromEntries(countTexts)))
    ;[this.radius.min, this.radius.max] = radii
    this.pace.replaceChildren(...makeOptions(Object.fromEntries(paces.map(pace => [pace, pace]))))
    el.replaceChildren(
      makeRow(this.where, this.count, this.otherStarts),
      makeElement("label", {className: "row radius"}, "Radius ", this.radius, this.radiusOutput),
      this.line,
      this.results,
      makeRow(
        this.step,
        this.film,
        this.pace,
        makeElement("label", {}, this.trails, " trails"),
        makeElement("label", {}, this.loop, " loop"),
      ),
      this.note,
    )
  }

  /** Offer places of starts, with their phrases. @param {Record<string, string>} places */
  offer(places) {
    this.where.replaceChildren(...makeOptions(places))
  }

  /**
   * Show the choice of starts.
   *
   * @param {{where: string, count: number, radius: number}} choice
   */
  choose({where, count, radius}) {
    this.where.value = where
    this.count.value = String(count)
    this.radius.value = String(radius)
    this.radiusOutput.textContent = `10^${radius}`
    this.radius.closest(".radius").hidden = where !== "disc"
    this.growth.hidden = where !== "disc"
  }

  /** Label the button for playing by what it does. @param {boolean} isPlaying */
  labelPlay(isPlaying) {
    this.play.textContent = isPlaying ? "❚❚ Pause" : "▶ Watch them leave"
    this.play.setAttribute("aria-pressed", String(isPlaying))
  }

  /**
   * Write the number and the share of the orbits that are inside, and of those that have reached each exit.
   *
   * @param {import("../../../../plots/browser/modules/engine/ensemble.js").Ensemble} ensemble
   * @param {import("./present.js").Shown} shown
   */
  writeCounters({channel, count}, shown) {
    const [names, colours] = [["inside", ...shown.labels()], shown.colours()]
    const counts = new Array(names.length).fill(0)
    for (const code of channel) counts[code]++
    const cells = counts.map((endCount, code) => {
      const share = percentWithDecimal(count ? endCount / count : 0)
      const cell = makeElement("td", {}, `${names[code]}: ${whole(endCount)} (${share})`)
      if (code) cell.style.setProperty("--colour", colours[code - 1])
      return cell
    })
    this.counters.replaceChildren(makeElement("tbody", {}, makeElement("tr", {}, ...cells)))
  }

  /**
   * Describe the growth of a disc as a factor and as a rate. While the disc is small and the motion chaotic, the rate is close to
   * the Lyapunov exponent.
   *
   * @param {number} growth
   * @param {number} time  in units of the page
   */
  writeGrowth(growth, time) {
    const isKnown = time > 0 && growth > 0 && growth < Infinity
    this.growth.textContent = isKnown
      ? `${number(growth, 3)} times as wide as at the start: ln(width)/t = ${number(Math.log(growth) / time, 3)}`
      : ""
  }
}
