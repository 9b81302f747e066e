// @ts-check
/** The player of an ensemble: its orbits, their time, and what the page shows of them. */

import {Ensemble, Outcomes} from "../../../../plots/browser/modules/engine/ensemble.js"
import {Integrator} from "../../../../plots/browser/modules/engine/integrator.js"
import {drawStarts} from "../../../../plots/browser/modules/engine/random_starts.js"
import {energyAxis, windowAt} from "../../../../plots/browser/modules/engine/starts.js"
import {count as whole, number} from "../../../../plots/browser/modules/numbers.js"
import {Particles} from "../painting/particles.js"
import {onMoved} from "../painting/pictures.js"
import {drawSurvival} from "../painting/survival_chart.js"
import {Film} from "./film.js"
import {onPresent, present} from "./present.js"
import {SLIDER_STEPS, WatchControls} from "./watch_controls.js"

/** Longest time of the player, in units of the well. */
const LONGEST_TIME = 100
/** Time from which the logarithmic pace begins, in units of the well. */
const FIRST_TIME = 0.5
/** Playing time by which the button "Step" advances the ensemble, in seconds. */
const STEP_SECONDS = 0.05
/** Number of frames from one update of the numbers to the next, while the ensemble plays. */
const FRAMES_PER_UPDATE = 6
/** Time in each frame for finding the outcomes of orbits, in ms. */
const OUTCOMES_MS = 6
/** Largest playing time of a frame, in ms. Frames of a hidden page take longer. */
const LONGEST_FRAME_MS = 100

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

/** Number of presses of the page's button that players have followed. */
let followedPresses = 0

class EnsemblePlayer {
  /**
   * @param {any} model  of the component in `app/views/orbits/ensemble_player.py`
   * @param {HTMLElement} el
   */
  constructor(model, el) {
    this.#model = model
    this.#controls = new WatchControls(el, model, Object.keys(PACES))
    this.#controls.pace.value = "normal"
    this.#listen()
    this.#follow()
  }

  #model
  #controls
  #particles = new Particles()
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
    const [model, controls] = [this.#model, this.#controls]
    controls.where.onchange = () => this.#choose({where: controls.where.value})
    controls.count.onchange = () => this.#choose({count: Number(controls.count.value)})
    controls.radius.oninput = () => this.#choose({radius: Number(controls.radius.value)})
    controls.otherStarts.onclick = () => this.#choose({seed: model.seed + 1})
    controls.play.onclick = () => this.#setPlaying(this.#playFrame === 0)
    controls.film.onclick = () => this.#playFilm()
    controls.step.onclick = () => this.#goTo(this.#nextTime(STEP_SECONDS))
    controls.close.onclick = () => model.send_msg({closed: true})
    controls.time.oninput = () => this.#goTo((controls.time.valueAsNumber / SLIDER_STEPS) * LONGEST_TIME)
    const offer = () => {
      controls.offer(model.places)
      controls.choose(model)
    }
    offer()
    model.on("places", offer)
    model.on(["where", "count", "seed", "radius", "point", "box", "rate"], () => this.#follow())
    model.on("presses", () => this.#followPresses())
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
    this.#controls.choose(this.#model)
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
    this.#followPresses()
  }

  /** Play or pause after a press of the page's button, once there are orbits. */
  #followPresses() {
    if (!this.#ensemble?.count || this.#model.presses === followedPresses) return
    followedPresses = this.#model.presses
    this.#setPlaying(this.#playFrame === 0)
    this.#controls.play.focus({preventScroll: true})
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
    // Without the window of the well, its picture cannot show orbits.
    if (!windowAt(integrator, "x_y", scene.energy)) return
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
    this.#showPictures()
    let lastTime = performance.now()
    const tick = (/** @type {number} */ now) => {
      const seconds = Math.min(Math.max(now - lastTime, 0), LONGEST_FRAME_MS) / 1000
      lastTime = now
      this.#goTo(this.#nextTime(seconds))
      if (this.#hasEnded && this.#controls.loop.checked) this.#goToBegin()
      if (this.#hasEnded) return this.#setPlaying(false)
      this.#playFrame = requestAnimationFrame(tick)
    }
    this.#playFrame = requestAnimationFrame(tick)
    this.#controls.labelPlay(true)
  }

  /** Where the results are below the pictures, show both the pictures and a line of the controls. */
  #showPictures() {
    const {line} = this.#controls
    line.classList.add("watched")
    if (getComputedStyle(line).position === "fixed") scrollTo({top: 0})
  }

  /** Play from the beginning, and save a film that ends with the next pause. */
  #playFilm() {
    const host = present()?.host
    if (!host) return
    this.#setPlaying(false)
    this.#goToBegin()
    const energy = () => number(present()?.scene()?.energy ?? NaN, 6)
    this.#film = new Film(host, "escapes-orbits", () => `h = ${energy()}, ${this.#controls.timeOutput.textContent}`)
    this.#film.start()
    this.#setPlaying(true)
  }

  #endFilm() {
    this.#film?.end()
    this.#film = null
  }

  /** Return the time that is reached after some seconds of playing. @param {number} seconds */
  #nextTime(seconds) {
    return PACES[this.#controls.pace.value](this.#time, seconds)
  }

  get #isBackwards() {
    return this.#controls.pace.value === "backwards"
  }

  /** Whether the time has reached the end of the present pace. */
  get #hasEnded() {
    return this.#isBackwards ? this.#time <= 0 : this.#time >= LONGEST_TIME
  }

  /** Go to the time at which the present pace begins. */
  #goToBegin() {
    this.#goTo(this.#isBackwards ? LONGEST_TIME : 0)
  }

  /** Go to a time, in units of the well. @param {number} time */
  #goTo(time) {
    this.#ensemble?.advance(Math.min(time, LONGEST_TIME))
    this.#draw()
  }

  /** Show the controls, the particles, the numbers and the chart at the present time. */
  #draw() {
    const [ensemble, integrator, shown, controls] = [this.#ensemble, this.#integrator, present(), this.#controls]
    controls.labelPlay(this.#playFrame !== 0)
    const isEmpty = !ensemble?.count
    for (const control of [controls.play, controls.step, controls.film, controls.time]) control.disabled = isEmpty
    controls.results.hidden = isEmpty
    controls.note.textContent = this.#explain()
    if (!ensemble || !integrator || !shown) return this.#particles.hide()
    const time = this.#time * shown.system.units.time
    controls.time.valueAsNumber = (SLIDER_STEPS * this.#time) / LONGEST_TIME
    controls.timeOutput.textContent = `t = ${time.toFixed(time < 100 ? 1 : 0)}`
    const channel = this.#outcomes?.channel ?? []
    this.#particles.show({ensemble, integrator, channel, hasTrails: controls.trails.checked}, shown)
    // Numbers that change in every frame could not be read.
    if (this.#playFrame !== 0 && this.#paintedFrames++ % FRAMES_PER_UPDATE) return
    controls.writeCounters(ensemble, shown)
    if (this.#model.where === "disc") controls.writeGrowth(ensemble.growth(), time)
    const ink = getComputedStyle(controls.chart).color
    drawSurvival(controls.chart, ensemble, {longest: LONGEST_TIME, unit: shown.system.units.time, rate: this.#model.rate, ink})
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
    const words = this.#controls.where.selectedOptions[0].textContent
    const longest = number(LONGEST_TIME * (present()?.system.units.time ?? 1), 3)
    const starts = `${whole(this.#ensemble.count)} starts ${words}`
    return `${starts}, in the colours of the exits that they will take; grey ones are still inside at t = ${longest}.`
  }

  #end() {
    this.#endFilm()
    cancelAnimationFrame(this.#playFrame)
    cancelAnimationFrame(this.#outcomesFrame)
    this.#ignorePage()
    this.#ignoreMoves()
    this.#particles.remove()
  }
}

/**
 * Start the player of a component.
 *
 * @param {any} model
 * @param {HTMLElement} el
 */
export const start = (model, el) => void new EnsemblePlayer(model, el)
