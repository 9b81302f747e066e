// @ts-check
/** Cards with pictures, in groups, and their captions. The component sends the key of the chosen card. */

/** @typedef {{key: string, group: string, title: string, caption: string, line: string, alt: string, thumbnail: string}} Card */

/** @type {(tag: string, attributes: object, ...children: (Node | string)[]) => HTMLElement} */
const make = (tag, attributes, ...children) => {
  const node = Object.assign(document.createElement(tag), attributes)
  node.append(...children)
  return node
}

// The Tab key stops once at a toolbar. Arrow keys move from card to card.
/** @type {Record<string, (index: number, count: number) => number>} */
const STEPS = {ArrowRight: index => index + 1, ArrowLeft: index => index - 1, Home: () => 0, End: (_, count) => count - 1}

/** @param {KeyboardEvent} event @param {HTMLElement[]} buttons */
function moveFocus(event, buttons) {
  const index = buttons.findIndex(button => button === event.target)
  const next = buttons[STEPS[event.key]?.(index, buttons.length)]
  if (index < 0 || next === undefined) return
  event.preventDefault()
  buttons[index].tabIndex = -1
  next.tabIndex = 0
  next.focus()
}

/**
 * Make a card with a line below its title, or with its caption as the description for screen readers.
 *
 * @param {Card} card @param {number} index @param {(card: Card | null) => void} show
 */
function makeCard(card, index, show) {
  // With loading set after src, the browser would fetch the picture at once, even in a closed gallery.
  const picture = make("img", {loading: "lazy", alt: card.alt, width: 112, height: 112, src: card.thumbnail})
  const button = make("button", {type: "button", tabIndex: index ? -1 : 0}, card.title, picture)
  button.dataset.key = card.key
  if (card.line) {
    button.append(make("small", {}, card.line))
    return [button]
  }
  const description = make("span", {hidden: true, id: `caption-${card.key}`}, card.caption)
  button.setAttribute("aria-describedby", description.id)
  for (const event of ["pointerenter", "focus"]) button.addEventListener(event, () => show(card))
  for (const event of ["pointerleave", "blur"]) button.addEventListener(event, () => show(null))
  return [button, description]
}

/** Whether all words of a search are in the texts of a card. @type {(card: Card | undefined, search: string) => boolean} */
export function matches(card, search) {
  const text = card ? Object.values(card).join(" ").toLowerCase() : ""
  return search
    .toLowerCase()
    .split(/\s+/)
    .every(word => text.includes(word))
}

/**
 * Make a box that hides the cards, and the groups without cards, that do not match what is typed.
 *
 * @param {Card[]} cards @param {HTMLElement[]} groups
 */
function makeSearch(cards, groups) {
  const search = /** @type {HTMLInputElement} */ (
    make("input", {type: "search", placeholder: "Search", ariaLabel: "Search the gallery"})
  )
  search.addEventListener("input", () => {
    for (const group of groups) {
      const buttons = [...group.querySelectorAll("button")]
      for (const button of buttons) {
        button.hidden = !matches(
          cards.find(card => card.key === button.dataset.key),
          search.value,
        )
      }
      const shown = buttons.filter(button => !button.hidden)
      buttons.forEach(button => (button.tabIndex = button === shown[0] ? 0 : -1))
      group.hidden = shown.length === 0
    }
  })
  return search
}

/** @param {{model: any, el: HTMLElement}} component */
export function render({model, el}) {
  /** @type {Card[]} */
  const cards = model.cards
  const caption = make("p", {})
  // For screen readers, captions are descriptions of the buttons.
  caption.setAttribute("aria-hidden", "true")
  /** @type {Card | null} */
  let chosen = null
  const show = (/** @type {Card | null} */ card) => {
    const described = card ?? chosen
    caption.className = described ? "" : "hint"
    caption.replaceChildren(...(described ? [make("b", {}, described.title), ` ${described.caption}`] : [model.hint]))
  }
  const strips = model.groups.map((/** @type {string} */ group) => {
    const strip = make("div", {})
    strip.setAttribute("role", "toolbar")
    strip.setAttribute("aria-label", `Gallery: ${group}`)
    const groupCards = cards.filter(card => card.group === group)
    strip.append(...groupCards.flatMap((card, index) => makeCard(card, index, show)))
    const buttons = [...strip.querySelectorAll("button")]
    const shown = () => buttons.filter(button => !button.hidden)
    strip.addEventListener("keydown", event => moveFocus(event, shown()))
    return make("section", {}, make("h3", {}, group), strip)
  })
  const body = model.hint
    ? make("div", {className: "gallery"}, makeSearch(cards, strips), ...strips, caption)
    : make("div", {className: "gallery few"}, ...strips)
  body.addEventListener("click", event => {
    const button = event.target instanceof Element && event.target.closest("button")
    if (!button) return
    chosen = cards.find(card => card.key === button.dataset.key) ?? null
    body.querySelector("[aria-current]")?.removeAttribute("aria-current")
    button.setAttribute("aria-current", "true")
    show(chosen)
    model.send_msg(button.dataset.key)
  })
  show(null)
  el.replaceChildren(body)
}
