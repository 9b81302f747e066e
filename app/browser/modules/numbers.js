// @ts-check
/** Numbers as text: significant digits, typographic signs, and groups of digits that stay on one line. */

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹"

/**
 * A number with some significant digits, such as "1.9 × 10⁻¹²".
 *
 * @param {number} value
 * @param {number} [digits]
 */
export function number(value, digits = 4) {
  const size = Math.abs(value)
  if (size > 0 && (size < 1e-4 || size >= 10 ** (digits + 1))) return power(value, digits)
  return groups(String(Number(value.toPrecision(digits))).replace("-", "−"))
}

/** A whole number. @param {number} value */
export function count(value) {
  return groups(String(Math.round(value)).replace("-", "−"))
}

/**
 * A share of 1, as a percentage.
 *
 * @param {number} value
 * @param {number} [digits]
 */
export function percent(value, digits = 3) {
  return `${number(100 * value, digits)}\u202f%`
}

/** A share of 1, as a percentage with one decimal. @param {number} value */
export function share(value) {
  return `${(100 * value).toFixed(1)}\u202f%`
}

/**
 * @param {number} value
 * @param {number} digits
 */
function power(value, digits) {
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e")
  const raised = exponent
    .replace("+", "")
    .replace("-", "⁻")
    .replace(/\d/g, digit => SUPERSCRIPTS[Number(digit)])
  return `${String(Number(mantissa)).replace("-", "−")} × 10${raised}`
}

/** @param {string} text */
function groups(text) {
  return text.replace(/^(−?)(\d{4,})/, (_, sign, whole) => sign + whole.replace(/\B(?=(\d{3})+$)/g, "\u202f"))
}
