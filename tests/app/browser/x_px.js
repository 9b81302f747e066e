// @ts-check
/** The slice (x, px) of a well whose units are 1. @type {import("../../../app/browser/modules/system.js").Slice} */
export const X_PX = {
  axes: ["x", "px"],
  units: [1, 1],
  moves: [{x: 1}, {px: 1}],
  fixed: {y: 0},
  decided: "py",
  sign: 1,
  mirrored: [true, true],
}
