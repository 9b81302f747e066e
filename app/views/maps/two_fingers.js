// @ts-check
/**
 * Change ranges so that the point between two fingers stays between them, at the scale of their distance.
 *
 * @param {{event_name: string, x: number, y: number, scale: number}} event
 * @param {{start: number, end: number, min_interval: number | null, setv: (edges: object) => void}[]} ranges  of x and y
 * @param {{point: number, side: number}[]} held  for each axis, point and side at the beginning; set in place
 */
export function followFingers(event, ranges, held) {
  const middle = [event.x, event.y]
  ranges.forEach((range, axis) => {
    const {start, end} = range
    if (event.event_name === "pinchstart") {
      held[axis] = {point: middle[axis], side: end - start}
      return
    }
    const side = Math.max(held[axis].side / event.scale, range.min_interval ?? 0)
    const low = held[axis].point - (side * (middle[axis] - start)) / (end - start)
    range.setv({start: low, end: low + side})
  })
}
