// @ts-check
/**
 * The value of an input. Each value that is sent has a number. A value from the server that does not count the last one sent is
 * older than it.
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
    this.count = model.shown.count
    /** Whether the input has a value that has not been sent. */
    this.unsent = false
    this.done = true
  }

  /** Show the value from the server, unless the input has a newer one. */
  follow() {
    if (!this.unsent && this.model.shown.count >= this.count) this.write(this.model.shown.value)
  }

  /** The value changes; it is sent when it is final. */
  begin() {
    this.unsent = true
    this.done = false
  }

  /** The value changes, and is sent at once. */
  change() {
    this.done = false
    this.send()
  }

  /** The value that was begun or changed is final. */
  finish() {
    if (this.done) return
    this.done = true
    this.send()
  }

  /** The value that was begun is dropped. */
  cancel() {
    this.unsent = false
    this.done = true
    this.follow()
  }

  send() {
    this.unsent = false
    this.model.send_msg({value: this.read(), count: ++this.count, done: this.done})
  }
}
