// @ts-check
/** Connects the component on the page (`app/views/panels/engine_component.py`) with the modules. */

import {Card} from "./gestures/card.js"
import {Film} from "./gestures/film.js"
import {Frames} from "../../../plots/browser/modules/workers/frames.js"
import {number} from "../../../plots/browser/modules/numbers.js"
import {highlightPixels} from "./painting/legend.js"
import {Overlay} from "./painting/overlay.js"
import {Relief} from "./painting/relief.js"
import {StartLine} from "./painting/start_line.js"
import {EnergyPlayer} from "../../../plots/browser/modules/gestures/player.js"
import {Pool, workerCount} from "../../../plots/browser/modules/workers/pool.js"
import {hasVectors} from "../../../plots/browser/modules/workers/vectors.js"
import {setPresent} from "./gestures/present.js"
import {Preview} from "./gestures/preview.js"
import {keepSharp} from "./gestures/sharpness.js"
import {ShareStrip} from "./gestures/share_strip.js"
import {storeOf} from "./view_store.js"

/** Names of the commands that start an animation of the energy. */
const STARTS = ["play", "film"]

/**
 * Start the previews, the card and the animation of the energy.
 *
 * @param {any} model  of the component
 * @param {HTMLElement} el  element of the component
 */
export function start(model, el) {
  highlightPixels()
  if (!hasVectors()) {
    // Without vector instructions, the last map stays until the next map arrives, and the energy cannot be played.
    const endAnimation = () => {
      if (STARTS.includes(model.command.name)) model.send_msg({playing: false})
    }
    model.on("command", endAnimation)
    endAnimation()
    return
  }
  const find = (/** @type {string} */ name) => model.document.get_model_by_name(name)
  // Sources of different pictures have the same names.
  const findSource = (/** @type {string} */ picture, /** @type {string} */ name) =>
    find(picture)
      .renderers.map((/** @type {any} */ renderer) => renderer.data_source)
      .find((/** @type {any} */ source) => source?.name === name)
  const kernels = WebAssembly.compileStreaming(fetch(new URL("../../../kernels.wasm", import.meta.url)))
  const worker = new URL("../../../plots/browser/modules/workers/worker.js", import.meta.url)
  const pool = new Pool(() => new Worker(worker, {type: "module"}))
  const frames = new Frames(pool, workerCount(), (view, pixels, isMoving) => preview.show(view, pixels, isMoving))
  const store = storeOf(model.document)
  keepSharp(find("maps"), store)
  const relief = new Relief(() => model.view.well)
  const overlay = new Overlay(el, relief)
  /** @type {Preview} */
  const preview = new Preview(find, findSource, frames, overlay, store)
  const startLine = new StartLine(el, () => overlay.isShown)
  const film = new Film(el, "escapes-energy", () => `h = ${number(store.energy.value, 6)}`)
  const player = new EnergyPlayer(
    energy => store.energy.hold(energy),
    energy => {
      film.end()
      store.energy.hold(Number(energy.toFixed(Math.max(model.command.decimals, 0))))
      store.energy.finish()
      model.send_msg({playing: false})
    },
  )
  const card = new Card(
    el,
    startLine,
    relief,
    () => preview.scene,
    () => find("maps").data,
    () => model.view,
  )
  // The last system from the server, and its compiled modules.
  /** @type {{system: import("../../../plots/browser/modules/engine/system.js").System, modules: import("../../../plots/browser/modules/engine/integrator.js").Modules} | null} */
  let compiled = null
  const strip = store.rail && new ShareStrip(store.rail, frames, energy => preview.sceneAt(energy))
  const updatePresent = () => {
    strip?.follow(model.view, compiled?.system ?? null)
    const colours = () => model.view.colours ?? []
    const labels = () => model.view.labels ?? []
    setPresent(
      compiled && model.view.system === compiled.system.key
        ? {...compiled, scene: () => preview.scene, colours, labels, host: el}
        : null,
    )
  }
  const receiveView = () => {
    if (!model.view.system) return
    preview.setView(model.view)
    updatePresent()
  }
  const receiveSystem = async () => {
    if (!model.system.key) return
    const {key} = model.system
    const modules = {kernels: await kernels, system: await WebAssembly.compile(model.system.module)}
    // Another system may have come during the compilation.
    if (model.system.key !== key) return
    const {module: _, ...system} = model.system
    for (const part of [card, preview]) part.setSystem(system, modules)
    compiled = {system, modules}
    updatePresent()
  }
  const runCommand = () => {
    const {name, low, high} = model.command
    if (name === "stop") return player.stop()
    if (name === "film") film.start()
    player.start(store.energy.value, low, high)
  }
  // An energy of the server may arrive after the view.
  store.energy.listen(() => store.energy.isNewer || updatePresent())
  model.on("view", receiveView)
  model.on("system", receiveSystem)
  model.on("command", runCommand)
  receiveView()
  void receiveSystem()
  if (STARTS.includes(model.command.name)) runCommand()
}
