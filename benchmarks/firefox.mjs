// @ts-check
/**
 * The page in Firefox: drag, orbit under the cursor and many orbits, with pictures of the page.
 *
 * Needs Firefox, and puppeteer-core, which is installed in a folder of its own (npm install puppeteer-core). Run while the server runs:
 * node benchmarks/firefox.mjs ADDRESS FOLDER_OF_PUPPETEER FOLDER_OF_PICTURES [PROGRAM]
 */

import {readFileSync} from "node:fs"
import {createRequire} from "node:module"
import {pathToFileURL} from "node:url"

const [address, tools, pictures, executablePath = "/usr/bin/firefox-esr"] = process.argv.slice(2)
const {default: puppeteer} = await import(pathToFileURL(createRequire(`${tools}/`).resolve("puppeteer-core")).href)
const SECONDS = 4
const COMPLETE = "window.Bokeh?.documents[0]?.get_model_by_name('maps')?.data.complete[0] === true"
const MAP = `(() => {
  const view = [...Bokeh.index.all_views()].find(each => each.model.tags?.[0] === "map")
  const {left, top} = view.canvas_view.el.getBoundingClientRect()
  const {left: x, top: y, width, height} = view.frame.bbox
  return [left + x, top + y, width, height]
})()`

const browser = await puppeteer.launch({browser: "firefox", executablePath, headless: true, protocolTimeout: 300_000})
const page = await browser.newPage()
await page.setViewport({width: 1600, height: 1000})
/** @type {string[]} */
const problems = []
page.on("console", (/** @type {any} */ message) => message.type() === "error" && problems.push(message.text()))
page.on("pageerror", (/** @type {any} */ error) => problems.push(String(error)))
const shoot = (/** @type {string} */ name) => page.screenshot({path: `${pictures}/firefox-${name}.png`})
const middle = (/** @type {number[]} */ values) => values.sort((one, other) => one - other)[values.length >> 1]

const begun = performance.now()
await page.goto(`${address}?case=III&h=0.45&t_max=1000&analysis=watch&watch=well,5000,1,-2`, {waitUntil: "domcontentloaded"})
await page.waitForFunction(COMPLETE, {timeout: 300_000})
console.log(`${await browser.version()}: complete map after ${((performance.now() - begun) / 1000).toFixed(2)} s`)
const script = readFileSync(new URL("./drag.js", import.meta.url), "utf-8")
await page.evaluate(`(async () => { ${script}; window.bench = bench; await bench.ready() })()`)
const drag = `bench.drag(bench.rail(), 0.39, 0.51, ${SECONDS})`
await page.evaluate(drag)
const {delays, sides, frames} = await page.evaluate(drag)
await shoot("drag")
const rates = `${sides.length / SECONDS} pictures and ${frames / SECONDS} frames per second`
console.log(`drag: ${rates}, delay ${middle(delays).toFixed(0)} ms, at most ${Math.max(...delays).toFixed(0)} ms`)
await page.evaluate('document.dispatchEvent(new CustomEvent("energyreleased"))')
const [left, top, width, height] = await page.evaluate(MAP)
const points = Array.from({length: 40}, (_, k) => [left + width * (0.3 + 0.01 * k), top + 0.4 * height])
console.log(`orbit under the cursor: ${middle(await page.evaluate(`bench.hover(${JSON.stringify(points)})`)).toFixed(1)} ms`)
await page.mouse.move(left + 0.42 * width, top + 0.45 * height)
await shoot("hover")
await page.mouse.move(5, 5)
const watched = await page.evaluate(`bench.watch(5, ${SECONDS})`)
await shoot("watch")
console.log(
    `5000 orbits: first picture ${middle(watched.starts).toFixed(0)} ms, ${watched.frames.length / SECONDS} frames per second`,
)
console.log("problems:", problems)
await browser.close()
