// @ts-check
/** The input of a script that a test in Python runs: JSON with the path of a module. */

import {readFileSync} from "node:fs"

export const input = JSON.parse(readFileSync(process.argv[2], "utf-8"))
export const module = new WebAssembly.Module(readFileSync(input.module))
