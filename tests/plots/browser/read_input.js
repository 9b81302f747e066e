// @ts-check
/** The input of a script that a test in Python runs: JSON with the paths of modules. */

import {readFileSync} from "node:fs"

export const input = JSON.parse(readFileSync(process.argv[2], "utf-8"))
const [kernels, system] = [input.kernels, input.module].map(path => new WebAssembly.Module(readFileSync(path)))
export const modules = {kernels, system}
