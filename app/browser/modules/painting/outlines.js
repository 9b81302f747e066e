// @ts-check
/** The curves over a picture of Bokeh while the energy or the window changes: the limiting curve, the exits and their numbers. */

import {LocalWhenPresent} from "./local.js"

/**
 * @typedef {{xs: number[], ys: number[]}} Line
 * @typedef {ReturnType<typeof import("../../../../plots/browser/modules/engine/curves.js").exitLines>[number] & {colour: string}} Exit
 */

export class Outlines {
  /** @param {(name: string) => any} findSource  finds a data source of the picture */
  constructor(findSource) {
    const local = (/** @type {string} */ name) => new LocalWhenPresent(() => findSource(name), ["data"])
    this.#limit = local("zero_velocity_curve")
    this.#exits = local("lyapunov_orbits")
    this.#labels = local("channel_numbers")
  }

  #limit
  #exits
  #labels

  /**
   * Show other curves in place of the server's.
   *
   * @param {Line[]} limit
   * @param {Exit[]} exits
   */
  show(limit, exits) {
    this.#limit.show({data: sourceOf(limit)})
    if (exits.length > 0 || this.#exits.server.data) this.#showExits(exits)
  }

  restore() {
    for (const local of [this.#limit, this.#exits, this.#labels]) local.restore()
  }

  /** Show exits with their numbers. @param {Exit[]} exits */
  #showExits(exits) {
    this.#exits.show({data: {...sourceOf(exits), colour: exits.map(({colour}) => colour)}})
    const [x, y] = [0, 1].map(axis => exits.map(({label}) => label[axis]))
    this.#labels.show({data: {x, y, text: exits.map(({channel}) => String(channel))}})
  }
}

/** Return lines as the columns of a data source of Bokeh. @type {(lines: Line[]) => {xs: number[][], ys: number[][]}} */
const sourceOf = lines => ({xs: lines.map(({xs}) => xs), ys: lines.map(({ys}) => ys)})
