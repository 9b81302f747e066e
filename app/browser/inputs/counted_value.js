// @ts-check
/**
 * The value of an input. Sent values are numbered, and the server returns the number of the last value that it has received.
 * While this number is smaller than that of the last sent value, values from the server are older, and are ignored.
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

  /** Show the value from the server, unless the input has a newer value. */
  follow() {
    if (!this.isUnsent && this.model.shown.count >= this.count) this.write(this.model.shown.value)
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
