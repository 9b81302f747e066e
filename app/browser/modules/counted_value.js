// @ts-check
/**
 * The value of an input. Sent values are numbered, and the server returns the number of the last value that it has received.
 * While this number is smaller than that of the last sent value, values from the server are older, and are ignored. With a larger
 * number, the server has chosen a value itself, which replaces also a value that is not sent yet.
 */
export class CountedValue {
  /**
   * @param {any} model  of the component
   * @param {() => any} read  reads the value of the input
   * @param {(value: any) => void} write  writes a value to the input
   */
  constructor(model, read, write) {
    this.model = model
    this.read = read
    this.write = write
    /** Number of the last sent value. */
    this.count = model.shown.count
    /** Whether the input has a value that is not sent yet. */
    this.isUnsent = false
    /** Whether the last value is final. */
    this.isFinal = true
  }

  /** Whether the server has not received the value yet. */
  get isNewer() {
    return this.isUnsent || this.model.shown.count < this.count
  }

  /** Show the value from the server, unless the input has a newer value. */
  follow() {
    const {value, count} = this.model.shown
    if (this.isNewer && count <= this.count) return
    this.count = count
    this.isUnsent = false
    this.write(value)
  }

  /** Begin a change of the value, which is sent when it is final. */
  begin() {
    this.isUnsent = true
    this.isFinal = false
  }

  /** Send a change of the value at once. */
  change() {
    this.isFinal = false
    this.send()
  }

  /** Send the changed value as final. */
  finish() {
    if (this.isFinal) return
    this.isFinal = true
    this.send()
  }

  /** Drop a change that was begun. */
  cancel() {
    this.isUnsent = false
    this.isFinal = true
    this.follow()
  }

  /** Send the value of the input with its number. */
  send() {
    this.isUnsent = false
    this.model.send_msg({value: this.read(), count: ++this.count, done: this.isFinal})
  }
}

/** A value that several parts of the page show and change. */
export class SharedValue extends CountedValue {
  /** @param {any} model  see `CountedValue` */
  constructor(model) {
    super(
      model,
      () => this.value,
      value => this.show(value),
    )
    this.value = model.shown.value
  }

  /** @type {Set<() => void>} */
  #listeners = new Set()
  /** Whether the listeners are called at the end of the task. */
  #tellsSoon = false

  /**
   * Call a function after each task in which the value has changed; return a function that ends this.
   *
   * @param {() => void} listener
   */
  listen(listener) {
    this.#listeners.add(listener)
    return () => void this.#listeners.delete(listener)
  }

  /** Show a value until the server shows another. @param {any} value */
  show(value) {
    this.value = value
    if (this.#tellsSoon) return
    this.#tellsSoon = true
    queueMicrotask(() => {
      this.#tellsSoon = false
      for (const listener of this.#listeners) listener()
    })
  }

  /** Show a value that is not sent yet, in place of those of the server. @param {any} value */
  hold(value) {
    this.begin()
    this.show(value)
  }
}
