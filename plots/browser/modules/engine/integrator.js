// @ts-check
/** The compiled kernels for a system, and their memory with its arrays; see `engine/integrator/portable_kernels.py`. */

/**
 * WebAssembly modules: the kernels, which are the same for all systems, and the functions that systems of a structure share.
 *
 * @typedef {{kernels: WebAssembly.Module, system: WebAssembly.Module}} Modules
 */

/** Unit in which the memory of WebAssembly grows, in bytes. */
const PAGE_BYTES = 65536
/** Space for the local variables of kernels, below all arrays, in bytes. */
const STACK_BYTES = PAGE_BYTES
/** Space that stays free for the arrays that a kernel makes, in bytes. */
const SLACK_BYTES = 4 * PAGE_BYTES
/** Alignment of the addresses of arrays, in bytes. */
const ALIGNMENT = 16

/**
 * Types of views of the memory. A 64-bit integer has two entries, of which the first is the lower half.
 *
 * @typedef {{float64: Float64Array, int64: Int32Array, int8: Int8Array}} Views
 */

/** Types of numbers: size in bytes, and type of the view. */
const NUMBER_TYPES = {
  float64: {bytes: 8, view: Float64Array},
  int64: {bytes: 8, view: Int32Array},
  int8: {bytes: 1, view: Int8Array},
}

/**
 * An array in the memory of the kernels, in row-major order.
 *
 * @template {keyof Views} K
 */
export class Numbers {
  /**
   * @param {WebAssembly.Memory} memory
   * @param {K} kind
   * @param {number} address
   * @param {number[]} shape
   */
  constructor(memory, kind, address, shape) {
    this.#memory = memory
    this.#kind = kind
    this.address = address
    this.shape = shape
    /** The arguments that a kernel takes for the array. */
    this.kernelArguments = [address, ...shape]
  }

  #memory
  #kind
  /** @type {Views[K] | null} */
  #view = null

  /** The view of the numbers, which is valid until the memory grows. */
  get values() {
    if (this.#view?.buffer !== this.#memory.buffer) this.#view = this.#makeView()
    return this.#view
  }

  #makeView() {
    const {bytes, view} = NUMBER_TYPES[this.#kind]
    const length = (product(this.shape) * bytes) / view.BYTES_PER_ELEMENT
    return /** @type {Views[K]} */ (new view(this.#memory.buffer, this.address, length))
  }

  /**
   * Return the first entries along the first axis.
   *
   * @param {number} count
   */
  first(count) {
    const [, ...shape] = this.shape
    return new Numbers(this.#memory, this.#kind, this.address, [count, ...shape])
  }

  /**
   * Return the entry at an index along the first axis.
   *
   * @param {number} index
   */
  at(index) {
    const [, ...shape] = this.shape
    const address = this.address + index * product(shape) * NUMBER_TYPES[this.#kind].bytes
    return new Numbers(this.#memory, this.#kind, address, shape)
  }
}

/** @type {(numbers: number[]) => number} */
const product = numbers => numbers.reduce((one, other) => one * other, 1)

export class Integrator {
  /**
   * @param {import("./system.js").System} system
   * @param {Modules} modules
   */
  constructor(system, modules) {
    const {functions, heap} = system.layout
    this.system = system
    this.modules = modules
    const memory = new WebAssembly.Memory({initial: 1 + (STACK_BYTES + SLACK_BYTES) / PAGE_BYTES})
    const table = new WebAssembly.Table({initial: functions.length + 1, element: "anyfunc"})
    const env = {
      __linear_memory: memory,
      __stack_pointer: new WebAssembly.Global({value: "i32", mutable: true}, STACK_BYTES),
      __indirect_function_table: table,
      sin: Math.sin,
      cos: Math.cos,
      hypot: Math.hypot,
    }
    this.#memory = memory
    this.#heap = new Numbers(memory, "int64", heap, [1])
    this.#exports = exportsOf(modules.kernels, env)
    const systemFunctions = exportsOf(modules.system, env)
    // Entry 0 stays empty, because address 0 stands for no function.
    functions.forEach((name, k) => name in systemFunctions && table.set(k + 1, systemFunctions[name]))
    /** The addresses of the functions of the system, by name. */
    this.address = Object.fromEntries(functions.map((name, k) => [name, k + 1]))
    this.#free = STACK_BYTES
    this.table = this.array("float64", [system.table.length], system.table)
    /** The kernel that finds starts beyond an exit, and its first inputs. @type {[string, ...(number | Numbers<any>)[]]} */
    this.outsideTest = system.polynomial
      ? ["find_outside_polynomial", ...this.#polynomial(system.polynomial)]
      : ["find_outside", this.address.potential_slopes, this.table, system.innerRadius]
    /** The arrays of each exit over a saddle, see `#exitTable`; null for circles. */
    this.exitTables = system.exits.map(exit => ("row" in exit ? null : this.#exitTable(exit)))
  }

  #memory
  #heap
  #exports

  /** The address at which memory is free. */
  get #free() {
    return this.#heap.values[0]
  }

  set #free(address) {
    this.#heap.values[0] = address
  }

  /**
   * Return a polynomial as inputs of the kernel that finds starts beyond an exit, with space for intermediate results.
   *
   * @param {import("./system.js").PolynomialTable} polynomial
   */
  #polynomial({powers, coefficients, bernstein}) {
    const side = bernstein.length
    const exponents = this.array("int64", [powers.length, 2])
    powers.flat().forEach((power, k) => (exponents.values[2 * k] = power))
    return [
      exponents,
      this.array("float64", [coefficients.length], coefficients),
      this.array("float64", [side, side], bernstein.flat()),
      this.array("float64", [3, side]),
    ]
  }

  /** Return the nodes and the rows of a table as arrays. @param {import("./system.js").ExitTable} table */
  #exitTable({nodes, rows}) {
    return [
      this.array("float64", [nodes.length], nodes),
      this.array("float64", [nodes.length, rows[0]?.length ?? 0], rows.flat()),
    ]
  }

  /**
   * Make an array of zeros or of given numbers.
   *
   * @template {keyof Views} K
   * @param {K} kind
   * @param {number[]} shape
   * @param {ArrayLike<number>} [numbers]
   */
  array(kind, shape, numbers) {
    const address = this.#free
    const bytes = product(shape) * NUMBER_TYPES[kind].bytes
    const end = Math.ceil((address + bytes) / ALIGNMENT) * ALIGNMENT
    const missing = end + SLACK_BYTES - this.#memory.buffer.byteLength
    if (missing > 0) this.#memory.grow(Math.ceil(missing / PAGE_BYTES))
    this.#free = end
    const array = new Numbers(this.#memory, kind, address, shape)
    if (numbers) array.values.set(numbers)
    else array.values.fill(0)
    return array
  }

  /**
   * Make an array of integers from 0 to 2³² − 1. The upper halves stay 0.
   *
   * @param {ArrayLike<number>} numbers
   */
  integers(numbers) {
    const array = this.array("int64", [numbers.length])
    const {values} = array
    for (let k = 0; k < numbers.length; k++) values[2 * k] = numbers[k]
    return array
  }

  /**
   * Call a function, then release the memory of the arrays that the function has made.
   *
   * @template T
   * @param {() => T} use
   */
  temporarily(use) {
    const free = this.#free
    try {
      return use()
    } finally {
      this.#free = free
    }
  }

  /**
   * Call a kernel with numbers and arrays.
   *
   * @param {string} name
   * @param {(number | Numbers<any>)[]} inputs
   * @returns {number}
   */
  call(name, ...inputs) {
    const numbers = inputs.flatMap(input => (typeof input === "number" ? [input] : input.kernelArguments))
    // A kernel does not release the arrays that it makes.
    const free = this.#free
    const result = this.#exports[name](...numbers)
    this.#free = free
    return result
  }
}

/**
 * Return the functions of a module.
 *
 * @type {(module: WebAssembly.Module, env: WebAssembly.ModuleImports) => Record<string, Function>}
 */
const exportsOf = (module, env) => /** @type {any} */ (new WebAssembly.Instance(module, {env}).exports)
