// @ts-check
/** Films of the pictures on the screen: Bokeh's canvases, and the canvases over them, with a line of text. */

import {mapPictures, wellPicture} from "../painting/pictures.js"
import {saveFile} from "../save_file.js"

/** Forms of films, of which the first that the browser can record is taken, by the end of the file's name. */
const FORMS = {webm: ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"], mp4: ["video/mp4"]}
/** Largest rate, in frames per second. */
const RATE = 30
/** Height of the line of text, and the size of its letters, in pixels of the page. */
const LINE_HEIGHT = 28
const LETTERS = 15

/** Return the form of films in this browser, and the end of their names; null without any. */
export function filmForm() {
  if (!globalThis.MediaRecorder) return null
  for (const [ending, types] of Object.entries(FORMS))
    for (const type of types) if (MediaRecorder.isTypeSupported(type)) return {ending, type}
  return null
}

export class Film {
  /**
   * @param {HTMLElement} host  of the canvases over the pictures
   * @param {string} name  of the file, without its end
   * @param {() => string} describe  returns the line of text
   */
  constructor(host, name, describe) {
    this.#host = host
    this.#name = name
    this.#describe = describe
  }

  #host
  #name
  #describe
  #canvas = document.createElement("canvas")
  #frame = 0
  /** @type {MediaRecorder | null} */
  #recorder = null

  /** Begin a film of the pictures where they are now, unless one is under way. The file is saved when it has ended. */
  start() {
    const [form, box] = [filmForm(), boxOfPictures()]
    if (this.#recorder || !form || !box) return
    // Many encoders need even numbers.
    const even = (/** @type {number} */ length) => 2 * Math.ceil((length * devicePixelRatio) / 2)
    Object.assign(this.#canvas, {width: even(box.width), height: even(box.height + LINE_HEIGHT)})
    /** @type {Blob[]} */
    const parts = []
    const recorder = (this.#recorder = new MediaRecorder(this.#canvas.captureStream(RATE), {mimeType: form.type}))
    recorder.ondataavailable = ({data}) => parts.push(data)
    recorder.onstop = () => saveFile(`${this.#name}.${form.ending}`, new Blob(parts, {type: form.type}))
    const tick = () => {
      this.#paint(box)
      this.#frame = requestAnimationFrame(tick)
    }
    tick()
    recorder.start()
  }

  /** End the film after the present frame, and save it. */
  end() {
    cancelAnimationFrame(this.#frame)
    this.#recorder?.stop()
    this.#recorder = null
  }

  /** @param {DOMRect} box  of the pictures on the screen */
  #paint(box) {
    const context = this.#canvas.getContext("2d")
    if (!context) return
    const style = getComputedStyle(this.#host)
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0)
    context.fillStyle = style.getPropertyValue("--ui-page")
    context.fillRect(0, 0, this.#canvas.width, this.#canvas.height)
    const copy = (/** @type {HTMLCanvasElement} */ canvas) => {
      const {left, top, width, height} = canvas.getBoundingClientRect()
      if (!width || !height) return
      context.fillStyle = getComputedStyle(canvas).backgroundColor
      context.fillRect(left - box.left, top - box.top, width, height)
      context.drawImage(canvas, left - box.left, top - box.top, width, height)
    }
    for (const {view} of pictures()) copy(view.canvas_view.primary.el)
    for (const canvas of this.#host.querySelectorAll("canvas")) copy(canvas)
    context.fillStyle = style.getPropertyValue("--ui-ink")
    context.font = `${LETTERS}px system-ui, sans-serif`
    context.textBaseline = "middle"
    context.fillText(this.#describe(), LETTERS, box.height + LINE_HEIGHT / 2)
  }
}

/** The visible pictures. */
const pictures = () => [wellPicture(), ...mapPictures()].filter(picture => picture !== undefined)

/** Return the smallest box around all pictures; null without pictures. */
function boxOfPictures() {
  const boxes = pictures().map(({view}) => view.canvas_view.el.getBoundingClientRect())
  if (boxes.length === 0) return null
  const [left, top] = [Math.min(...boxes.map(box => box.left)), Math.min(...boxes.map(box => box.top))]
  const [right, bottom] = [Math.max(...boxes.map(box => box.right)), Math.max(...boxes.map(box => box.bottom))]
  return new DOMRect(left, top, right - left, bottom - top)
}
