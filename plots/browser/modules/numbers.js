// @ts-check
/** Numbers as text: significant digits, typographic signs, and groups of digits that stay on one line. */

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹"

/**
 * Write a number with some significant digits, such as "1.9 × 10⁻¹²".
 *
 * @param {number} value
 * @param {number} [digits]
 */
export function number(value, digits = 4) {
  const magnitude = Math.abs(value)
  if (magnitude > 0 && (magnitude < 1e-4 || magnitude >= 10 ** (digits + 1))) return withPower(value, digits)
  return groupDigits(String(Number(value.toPrecision(digits))).replace("-", "−"))
}

/** Write a whole number. @param {number} value */
export function count(value) {
  return groupDigits(String(Math.round(value)).replace("-", "−"))
}

/** Write a share of 1 as a percentage with three significant digits. @param {number} value */
export function percent(value) {
  return `${number(100 * value, 3)}\u202f%`
}

/** Write a share of 1 as a percentage with one decimal. @param {number} value */
export function percentWithDecimal(value) {
  return `${(100 * value).toFixed(1)}\u202f%`
}

/**
 * Write a number as a multiple of a power of ten.
 *
 * @param {number} value
 * @param {number} digits
 */
function withPower(value, digits) {
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e")
  const superscript = exponent
    .replace("+", "")
    .replace("-", "⁻")
    .replace(/\d/g, digit => SUPERSCRIPTS[Number(digit)])
  return `${String(Number(mantissa)).replace("-", "−")} × 10${superscript}`
}

/** Separate groups of three digits before the decimal point. @param {string} text */
function groupDigits(text) {
  return text.replace(/^(−?)(\d{4,})/, (_, sign, digits) => sign + digits.replace(/\B(?=(\d{3})+$)/g, "\u202f"))
}
