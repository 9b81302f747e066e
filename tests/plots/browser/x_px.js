// @ts-check
/** The slice (x, px) of a well whose units are 1. @type {import("../../../plots/browser/modules/engine/system.js").Slice} */
export const X_PX = {
  axes: ["x", "px"],
  units: [1, 1],
  motion: [
    [0, 0, 0, 0, 0, 0],
    [1, 0, 0, 0, 0, 0],
    [0, 0, 1, 0, 0, 0],
  ],
  decided: 3,
  sign: 1,
  mirrored: [true, true],
}
