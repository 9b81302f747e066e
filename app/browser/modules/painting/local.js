// @ts-check
/** Models of Bokeh that show other values in this browser than those that the server knows. */

/**
 * A model of Bokeh.
 *
 * @typedef {object} Model
 * @property {Record<string, any>} properties
 * @property {(values: Record<string, any>, options?: {sync: boolean}) => void} setv
 * @property {(signal: any, slot: () => void) => void} connect
 */

/** Like `Local`, for a model that may not be on the page yet. Until then, calls have no effect. */
export class LocalWhenPresent {
  /**
   * @param {() => any} find
   * @param {string[]} names  of the properties
   */
  constructor(find, names) {
    this.#make = () => {
      const model = find()
      return model && new Local(model, names)
    }
  }

  #make
  /** @type {Local | null} */
  #local = null

  /** The values that the server knows; empty until the model is on the page. */
  get server() {
    this.#local ??= this.#make()
    return this.#local?.server ?? {}
  }

  /** @param {Record<string, any>} values */
  show(values) {
    this.#local ??= this.#make()
    this.#local?.show(values)
  }

  restore() {
    this.#local?.restore()
  }

  /** @param {Record<string, any>} values */
  settle(values) {
    this.#local?.settle(values)
  }
}

/** Shows values of a model in this browser only, and keeps the values that the server knows. */
export class Local {
  /**
   * @param {Model & Record<string, any>} model
   * @param {string[]} names  of the properties
   * @param {() => void} onChange  called when the server or the visitor changes a value
   */
  constructor(model, names, onChange = () => {}) {
    this.#model = model
    /** The values that the server knows, by name. */
    this.server = Object.fromEntries(names.map(name => [name, model[name]]))
    this.#displayed = this.server
    for (const name of names) {
      model.connect(model.properties[name].change, () => {
        if (this.#isSetting) return
        this.server = {...this.server, [name]: model[name]}
        onChange()
      })
    }
  }

  #model
  /** The values that were shown last, which a change by the server may have replaced on the page. */
  #displayed
  #isSetting = false
  #showsPreview = false

  /** @param {Record<string, any>} values */
  show(values) {
    this.#set(values)
    this.#showsPreview = true
  }

  /** Show the values of the server again. */
  restore() {
    if (this.#showsPreview && this.#displayed !== this.server) this.#set(this.server)
    this.acceptServer()
  }

  /**
   * Show values that the server has sent. They may be those of the preview: then the page cannot see that the server has sent them.
   *
   * @param {Record<string, any>} values
   */
  settle(values) {
    this.server = values
    this.restore()
  }

  /** After a change by the server, show again the values that the change has replaced. */
  keepPreview() {
    this.show(this.#displayed)
  }

  /** After a change by the server, keep its values, which are already on the page. */
  acceptServer() {
    this.#displayed = this.server
    this.#showsPreview = false
  }

  /** @param {Record<string, any>} values */
  #set(values) {
    this.#displayed = values
    this.#isSetting = true
    this.#model.setv(values, {sync: false})
    this.#isSetting = false
  }
}
