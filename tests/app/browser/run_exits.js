// @ts-check
/** Points of the exits at some energies. */

import {exitCurves, exitPoint} from "../../../app/browser/modules/exits.js"
import {input} from "./read_input.js"

const {system, energies, positions} = input
const points = energies.map((/** @type {number} */ energy) =>
  exitCurves(system.exits, energy).map(curve =>
    positions.map((/** @type {number} */ s) => (curve.open ? exitPoint(curve, s) : null)),
  ),
)
console.log(JSON.stringify(points))
