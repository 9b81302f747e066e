// @ts-check
/** Loads the player of many orbits when it is first shown. */

/** @param {{model: any, el: HTMLElement}} component */
export function render({model, el}) {
  void import(new URL(model.address, document.baseURI).href).then(({watch}) => watch(model, el))
}
