// @ts-check
/** Loads the modules, which the server serves as files. */

/** @param {{model: any, el: HTMLElement}} component */
export function render({model, el}) {
  el.setAttribute("aria-hidden", "true")
  const address = new URL(model.address, document.baseURI).href
  void import(address).then(({start}) => start(model, el))
}
