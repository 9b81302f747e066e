// @ts-check
/**
 * The value of an input: each one that is sent has a number, and a value of the server that does not count them all is older than the
 * last one sent.
 */
export class CountedValue {
  /**
   * @param {any} model  of the component
   * @param {() => any} read  the value of the input
   * @param {(value: any) => void} write  a value to the input
   */
  constructor(model, read, write) {
    this.model = model
    this.read = read
    this.write = write
    this.count = model.shown.count
    /** Whether the input has a value that is not sent. */
    this.unsent = false
    this.done = true
  }

  /** Show the value of the server, unless there is a newer one. */
  follow() {
    if (!this.unsent && this.model.shown.count >= this.count) this.write(this.model.shown.value)
  }

  /** The value changes, and is sent when it is done. */
  begin() {
    this.unsent = true
    this.done = false
  }

  /** The value changes, and is sent at once. */
  change() {
    this.done = false
    this.send()
  }

  /** What was begun or changed is done. */
  finish() {
    if (this.done) return
    this.done = true
    this.send()
  }

  /** What was begun is dropped. */
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
