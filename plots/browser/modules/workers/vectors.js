// @ts-check
/** Whether the browser can run the kernels. */

/** A minimal WebAssembly module with a vector instruction. */
// prettier-ignore
const MODULE = Uint8Array.of(
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3,
  2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
)

/** Whether the browser supports the vector instructions of the kernels. */
export const hasVectors = () => WebAssembly.validate(MODULE)
