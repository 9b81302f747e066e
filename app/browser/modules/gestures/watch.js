// @ts-check
/** The player of an ensemble: its controls, particles over the well and the section, counters, and the chart of survival. */

import {Ensemble, Outcomes} from "../../../../plots/browser/modules/engine/ensemble.js"
import {Integrator} from "../../../../plots/browser/modules/engine/integrator.js"
import {drawStarts} from "../../../../plots/browser/modules/engine/random_starts.js"
import {energyAxis, windowAt} from "../../../../plots/browser/modules/engine/starts.js"
import {count as whole, number, percentWithDecimal} from "../../../../plots/browser/modules/numbers.js"
import {cover} from "../../../../plots/browser/modules/painting/canvas.js"
import {mapPictures, onMoved, wellPicture} from "../painting/pictures.js"
import {drawSurvival} from "../painting/survival_chart.js"
import {Film} from "./film.js"
import {onPresent, present} from "./present.js"

/** Longest time of the player, in units of the well. */
const LONGEST_TIME = 100
/** Time from which the logarithmic pace begins, in units of the well. */
const FIRST_TIME = 0.5
/** Number of steps of the slider of time. */
const SLIDER_STEPS = 1000
/** Playing time by which the button "Step" advances the ensemble, in seconds. */
const STEP_SECONDS = 0.05
/** Side of a particle, in pixels. */
const PARTICLE_SIDE = 2.5
/** Factor of the opacity of a trail from one frame to the next. */
const TRAIL_OPACITY = 0.88
/** Number of frames from one update of the numbers to the next, while the ensemble plays. */
const FRAMES_PER_UPDATE = 6
/** Opacity of the layer over the map, on which the crossings of the section are painted. */
const COVER_OPACITY = 0.85
/** Time in each frame for finding the outcomes of orbits, in ms. */
const OUTCOMES_MS = 6
/** Largest playing time of a frame, in ms. Frames of a hidden page take longer. */
const LONGEST_FRAME_MS = 100
/** Style of the canvases over the pictures. */
const STYLE = "position:fixed;pointer-events:none;z-index:1;display:none"

/**
 * The paces. Each function returns the new time of the orbits, given their time in the last frame and the seconds since then.
 * Times of orbits are in units of the well.
 *
 * @type {Record<string, (time: number, seconds: number) => number>}
 */
const PACES = {
  slow: (time, seconds) => time + seconds,
  normal: (time, seconds) => time + 4 * seconds,
  fast: (time, seconds) => time + 16 * seconds,
  logarithmic: (time, seconds) => Math.max(time, FIRST_TIME) * 2 ** (0.5 * seconds),
  backwards: (time, seconds) => Math.max(time - 4 * seconds, 0),
}

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

/** Return a drop-down list. @type {(label: string, options: Record<string, string>) => any} */
const makeList = (label, options) => {
  const list = makeElement("select", {className: "bk-input"}, ...makeOptions(options))
  list.setAttribute("aria-label", label)
  return list
}

class EnsemblePlayer {
  /**
   * @param {any} model  of the component in `app/views/orbits/ensemble_player.py`
   * @param {HTMLElement} el
   */
  constructor(model, el) {
    this.#model = model
    this.#where = makeList("Starts", model.places)
    const counts = model.counts.map((/** @type {number} */ each) => [
      each,
      `${each.toLocaleString("en").replaceAll(",", " ")} orbits`,
    ])
    this.#count = makeList("Number of orbits", Object.fromEntries(counts))
    ;[this.#radius.min, this.#radius.max] = model.radii
    this.#pace = makeList("Speed", Object.fromEntries(Object.keys(PACES).map(pace => [pace, pace])))
    this.#pace.value = "normal"
    this.#timeSlider.setAttribute("aria-label", "Time of the orbits")
    this.#radius.setAttribute("aria-label", "Radius of the disc, as a power of ten of the window")
    for (const canvas of [this.#wellCanvas, this.#sectionCanvas]) canvas.style.cssText = STYLE
    this.#trails.checked = false
    el.replaceChildren(
      makeElement("div", {className: "row"}, this.#where, this.#count, this.#otherStartsButton),
      makeElement("label", {className: "row radius"}, "Radius ", this.#radius, this.#radiusOutput),
      makeElement("div", {className: "row"}, this.#playButton, this.#stepButton, this.#filmButton),
      makeElement("div", {className: "row"}, this.#timeSlider, this.#timeOutput),
      makeElement(
        "div",
        {className: "row"},
        this.#pace,
        makeElement("label", {}, this.#trails, " trails"),
        makeElement("label", {}, this.#loop, " loop"),
      ),
      this.#note,
      this.#counters,
      this.#growth,
      this.#chart,
    )
    this.#listen()
    this.#follow()
  }

  #model
  #where
  #count
  #pace
  #otherStartsButton = makeElement("button", {type: "button", className: "bk-btn"}, "Other starts")
  #playButton = makeElement("button", {type: "button", className: "bk-btn play"})
  #stepButton = makeElement("button", {type: "button", className: "bk-btn"}, "Step")
  #filmButton = makeElement("button", {type: "button", className: "bk-btn"}, "● Film")
  #timeSlider = makeElement("input", {type: "range", min: 0, max: SLIDER_STEPS, step: 1, value: 0})
  #timeOutput = makeElement("output")
  #radius = makeElement("input", {type: "range", step: 0.5})
  #radiusOutput = makeElement("output")
  #trails = makeElement("input", {type: "checkbox"})
  #loop = makeElement("input", {type: "checkbox"})
  #note = makeElement("p", {className: "quiet"})
  #counters = makeElement("table")
  #growth = makeElement("p", {className: "quiet"})
  #chart = makeElement("canvas", {className: "survival"})
  #wellCanvas = makeElement("canvas")
  #sectionCanvas = makeElement("canvas")
  /** The film under way. @type {Film | null} */
  #film = null
  /** @type {Integrator | null} */
  #integrator = null
  /** @type {Ensemble | null} */
  #ensemble = null
  /** @type {Outcomes | null} */
  #outcomes = null
  #outcomesFrame = 0
  /** All choices and properties of the page that determine the ensemble, as text. */
  #ensembleKey = ""
  #playFrame = 0
  #paintedFrames = 0
  #ignorePage = onPresent(() => this.#follow())
  #ignoreMoves = onMoved(() => this.#draw())

  /** Follow the controls, and changes of the model by the server. */
  #listen() {
    const model = this.#model
    this.#where.onchange = () => this.#choose({where: this.#where.value})
    this.#count.onchange = () => this.#choose({count: Number(this.#count.value)})
    this.#radius.oninput = () => this.#choose({radius: Number(this.#radius.value)})
    this.#otherStartsButton.onclick = () => this.#choose({seed: model.seed + 1})
    this.#playButton.onclick = () => this.#setPlaying(this.#playFrame === 0)
    this.#filmButton.onclick = () => this.#playFilm()
    this.#stepButton.onclick = () => this.#goTo(PACES[this.#pace.value](this.#time, STEP_SECONDS))
    this.#timeSlider.oninput = () => this.#goTo((this.#timeSlider.valueAsNumber / SLIDER_STEPS) * LONGEST_TIME)
    model.on("places", () => {
      this.#where.replaceChildren(...makeOptions(model.places))
      this.#where.value = model.where
    })
    model.on(["where", "count", "seed", "radius", "point", "box", "rate"], () => this.#follow())
    model.on("lifecycle:remove", () => this.#end())
  }

  get #time() {
    return this.#ensemble?.time ?? 0
  }

  /**
   * Send a choice to the server, which returns the choice as a change of the model.
   *
   * @param {object} choice
   */
  #choose(choice) {
    const {where, count, seed, radius} = this.#model
    this.#model.send_msg({where, count, seed, radius, ...choice})
  }

  /** Follow the page and the choices. New starts begin at time 0, and play if the previous starts were playing. */
  #follow() {
    const {where, count, seed, radius, point, box} = this.#model
    this.#where.value = where
    this.#count.value = String(count)
    this.#radius.value = String(radius)
    this.#radiusOutput.textContent = `10^${radius}`
    this.#radius.closest(".radius").hidden = where !== "disc"
    const shown = present()
    const scene = shown?.scene() ?? null
    /** @type {Record<string, unknown>} */
    const placesInView = {view: scene, disc: [scene, radius, point], box: [scene, box]}
    // Starts at other places depend on the energy, but not on the window.
    const place = placesInView[where] ?? scene?.energy
    const ensembleKey = JSON.stringify([where, count, seed, place, scene?.slice, shown?.system.key])
    if (ensembleKey === this.#ensembleKey) return this.#draw()
    this.#ensembleKey = ensembleKey
    this.#ensemble = this.#outcomes = null
    if (shown && scene && energyAxis(scene.slice) < 0) this.#makeEnsemble(shown, scene)
    this.#findOutcomes()
    this.#goTo(0)
  }

  /** Find the exits through which the orbits leave, in the next frames. */
  #findOutcomes() {
    cancelAnimationFrame(this.#outcomesFrame)
    const tick = () => {
      const outcomes = this.#outcomes
      const startTime = performance.now()
      while (outcomes && !outcomes.complete && performance.now() - startTime < OUTCOMES_MS) outcomes.continue()
      if (this.#playFrame === 0) this.#draw()
      this.#outcomesFrame = outcomes && !outcomes.complete ? requestAnimationFrame(tick) : 0
    }
    this.#outcomesFrame = requestAnimationFrame(tick)
  }

  /**
   * Make the ensemble of random starts, and prepare the search for its outcomes.
   *
   * @param {import("./present.js").Shown} shown
   * @param {import("../../../../plots/browser/modules/workers/frames.js").Scene} scene
   */
  #makeEnsemble({system, modules}, scene) {
    const {where, count, seed, radius, point, box} = this.#model
    const integrator = (this.#integrator = new Integrator(system, modules))
    const isMissing = (where === "disc" && !point.length) || (where === "box" && !box.length)
    const request = {where: isMissing ? "view" : where, count, seed, point, box, radius: 10 ** radius}
    const states = drawStarts(request, scene, integrator)
    const energy = scene.energy / system.units.energy
    this.#ensemble = new Ensemble(integrator, energy, states)
    this.#outcomes = new Outcomes(system, modules, energy, states, LONGEST_TIME)
  }

  /** Play, from the beginning if the end is reached, or pause. @param {boolean} isPlaying */
  #setPlaying(isPlaying) {
    cancelAnimationFrame(this.#playFrame)
    this.#playFrame = 0
    if (!isPlaying) this.#endFilm()
    // While playing, most frames do not write the numbers, so write them at a pause.
    if (!isPlaying || !this.#ensemble) return this.#draw()
    if (this.#hasEnded) this.#goToBegin()
    let lastTime = performance.now()
    const tick = (/** @type {number} */ now) => {
      const seconds = Math.min(Math.max(now - lastTime, 0), LONGEST_FRAME_MS) / 1000
      lastTime = now
      this.#goTo(PACES[this.#pace.value](this.#time, seconds))
      if (this.#hasEnded && this.#loop.checked) this.#goToBegin()
      if (this.#hasEnded) return this.#setPlaying(false)
      this.#playFrame = requestAnimationFrame(tick)
    }
    this.#playFrame = requestAnimationFrame(tick)
    this.#labelPlay()
  }

  /** Play from the beginning, and save a film that ends with the next pause. */
  #playFilm() {
    const host = present()?.host
    if (!host) return
    this.#setPlaying(false)
    this.#goToBegin()
    const energy = () => number(present()?.scene()?.energy ?? NaN, 6)
    this.#film = new Film(host, "escapes-orbits", () => `h = ${energy()}, ${this.#timeOutput.textContent}`)
    this.#film.start()
    this.#setPlaying(true)
  }

  #endFilm() {
    this.#film?.end()
    this.#film = null
  }

  /** Whether the time has reached the end of the present pace. */
  get #hasEnded() {
    return this.#pace.value === "backwards" ? this.#time <= 0 : this.#time >= LONGEST_TIME
  }

  /** Go to the time at which the present pace begins. */
  #goToBegin() {
    this.#goTo(this.#pace.value === "backwards" ? LONGEST_TIME : 0)
  }

  /** Label the button for playing by what it does. */
  #labelPlay() {
    const isPlaying = this.#playFrame !== 0
    this.#playButton.textContent = isPlaying ? "❚❚ Pause" : "▶ Watch them leave"
    this.#playButton.setAttribute("aria-pressed", String(isPlaying))
  }

  /** Go to a time, in units of the well. @param {number} time */
  #goTo(time) {
    this.#ensemble?.advance(Math.min(time, LONGEST_TIME))
    this.#draw()
  }

  /** Show the controls, the particles, the numbers and the chart at the present time. */
  #draw() {
    const [ensemble, shown] = [this.#ensemble, present()]
    this.#labelPlay()
    for (const control of [this.#playButton, this.#stepButton, this.#filmButton, this.#timeSlider])
      control.disabled = !ensemble?.count
    this.#note.textContent = this.#explain()
    if (!ensemble || !shown) {
      for (const canvas of [this.#wellCanvas, this.#sectionCanvas]) canvas.style.display = "none"
      return
    }
    if (!this.#wellCanvas.isConnected) shown.host.append(this.#wellCanvas, this.#sectionCanvas)
    const time = this.#time * shown.system.units.time
    this.#timeSlider.valueAsNumber = (SLIDER_STEPS * this.#time) / LONGEST_TIME
    this.#timeOutput.textContent = `t = ${time.toFixed(time < 100 ? 1 : 0)}`
    this.#paintWell(ensemble, shown)
    this.#paintSection(ensemble, shown)
    // Numbers that change in every frame could not be read.
    if (this.#playFrame !== 0 && this.#paintedFrames++ % FRAMES_PER_UPDATE) return
    this.#writeCounters(ensemble, shown)
    this.#writeGrowth(ensemble, time)
    const ink = getComputedStyle(this.#chart).color
    drawSurvival(this.#chart, ensemble, {longest: LONGEST_TIME, unit: shown.system.units.time, rate: this.#model.rate, ink})
  }

  /** Return the text below the controls: what is shown, or what is missing. */
  #explain() {
    if (!present()) return "The engine in the browser is being loaded …"
    if (!this.#ensemble) return "Choose a slice of one energy and one potential, within the range of the slider."
    if (!this.#ensemble.count) return "There is no start inside the exits here."
    const {where, explanations, point, box} = this.#model
    if (where === "box" && !box.length) return 'Draw a box with "Count" first. These starts are in the view.'
    if (where === "disc" && !point.length) return "Click a map first. These starts are in the view."
    if (explanations[where]) return explanations[where]
    const words = this.#where.selectedOptions[0].textContent
    return `${whole(this.#ensemble.count)} starts ${words}, in the colours of the exits that they will take; grey ones stay.`
  }

  /**
   * Draw the orbits over the picture of the well.
   *
   * @param {Ensemble} ensemble
   * @param {import("./present.js").Shown} shown
   */
  #paintWell({x, y}, {system, scene, colours}) {
    const [picture, energy, integrator] = [wellPicture(), scene()?.energy, this.#integrator]
    const window = energy === undefined || !integrator ? null : windowAt(integrator, "x_y", energy)
    if (!picture || !window) return void (this.#wellCanvas.style.display = "none")
    const {length} = system.units
    this.#paint(this.#wellCanvas, picture.box, window, colours(), {xs: x, ys: y, units: [length, length]})
  }

  /**
   * Draw each orbit on the map of a slice on the section, at its last crossing of the section.
   *
   * @param {Ensemble} ensemble
   * @param {import("./present.js").Shown} shown
   */
  #paintSection(ensemble, {scene, colours}) {
    const [picture, view] = [mapPictures()[0], scene()]
    const [xs, ys] = view?.slice.sectionColumns?.map(column => ensemble.atSection(column)) ?? []
    // Before the first crossing, the map stays uncovered.
    if (!picture || !view || !xs?.some(Number.isFinite)) return void (this.#sectionCanvas.style.display = "none")
    const style = getComputedStyle(this.#note)
    this.#sectionCanvas.style.background = `color-mix(in srgb, ${style.getPropertyValue("--ui-page")} ${100 * COVER_OPACITY}%, transparent)`
    const points = {xs, ys, units: view.slice.units}
    this.#paint(this.#sectionCanvas, picture.box, view.window, colours(), points)
  }

  /**
   * Paint the orbits as particles in the colours of their exits. Orbits that stay have the colour of the text.
   *
   * @param {HTMLCanvasElement} canvas
   * @param {DOMRect} box
   * @param {import("../../../../plots/browser/modules/engine/starts.js").Window} window
   * @param {string[]} colours  of the outcomes
   * @param {{xs: Float64Array, ys: Float64Array, units: [number, number]}} points  a point for each orbit
   */
  #paint(canvas, box, window, colours, {xs, ys, units: [unitX, unitY]}) {
    const channel = this.#outcomes?.channel ?? []
    const context = cover(canvas, box)
    if (!context) return
    if (this.#trails.checked) {
      // Fade the particles of earlier frames.
      context.globalCompositeOperation = "destination-in"
      context.fillStyle = `rgba(0,0,0,${TRAIL_OPACITY})`
      context.fillRect(0, 0, box.width, box.height)
      context.globalCompositeOperation = "source-over"
    } else context.clearRect(0, 0, box.width, box.height)
    const [scaleX, scaleY] = [box.width / (window.xHigh - window.xLow), box.height / (window.ordinateHigh - window.ordinateLow)]
    // One colour at a time, because changing the colour of a canvas is slow.
    const inks = [getComputedStyle(this.#note).color, ...colours]
    inks.forEach((ink, code) => {
      context.fillStyle = ink
      for (let i = 0; i < xs.length; i++) {
        if (channel[i] !== code) continue
        const [left, top] = [(xs[i] * unitX - window.xLow) * scaleX, (window.ordinateHigh - ys[i] * unitY) * scaleY]
        if (left >= 0 && top >= 0 && left < box.width && top < box.height)
          context.fillRect(left - PARTICLE_SIDE / 2, top - PARTICLE_SIDE / 2, PARTICLE_SIDE, PARTICLE_SIDE)
      }
    })
  }

  /**
   * Write the number and the share of the orbits that are inside, and of those that have reached each exit.
   *
   * @param {Ensemble} ensemble
   * @param {import("./present.js").Shown} shown
   */
  #writeCounters({channel, count}, shown) {
    const [names, colours] = [["inside", ...shown.labels()], shown.colours()]
    const counts = new Array(names.length).fill(0)
    for (const code of channel) counts[code]++
    const cells = counts.map((endCount, code) => {
      const cell = makeElement(
        "td",
        {},
        `${names[code]}: ${whole(endCount)} (${percentWithDecimal(count ? endCount / count : 0)})`,
      )
      if (code) cell.style.setProperty("--colour", colours[code - 1])
      return cell
    })
    this.#counters.replaceChildren(makeElement("tbody", {}, makeElement("tr", {}, ...cells)))
  }

  /**
   * Describe the growth of a disc as a factor and as a rate. While the disc is small and the motion chaotic, the rate is close to
   * the Lyapunov exponent.
   *
   * @param {Ensemble} ensemble
   * @param {number} time  in units of the page
   */
  #writeGrowth(ensemble, time) {
    const isDisc = this.#model.where === "disc"
    this.#growth.hidden = !isDisc
    if (!isDisc) return
    const growth = ensemble.growth()
    const isKnown = time > 0 && growth > 0 && growth < Infinity
    this.#growth.textContent = isKnown
      ? `${number(growth, 3)} times as wide as at the start: ln(width)/t = ${number(Math.log(growth) / time, 3)}`
      : ""
  }

  #end() {
    this.#endFilm()
    cancelAnimationFrame(this.#playFrame)
    cancelAnimationFrame(this.#outcomesFrame)
    this.#ignorePage()
    this.#ignoreMoves()
    for (const canvas of [this.#wellCanvas, this.#sectionCanvas]) canvas.remove()
  }
}

/**
 * Start the player of a component.
 *
 * @param {any} model
 * @param {HTMLElement} el
 */
export const start = (model, el) => void new EnsemblePlayer(model, el)
