// @ts-check
/** Loads the module of a component when the component is first shown. */

/** @param {{model: any, el: HTMLElement}} component */
export function render({model, el}) {
  void import(new URL(model.address, document.baseURI).href).then(({start}) => start(model, el))
}
