/** What the modules use of BokehJS, which has no types for scripts on a page. */
declare const Bokeh: {
  documents: any[]
  index: {all_views(): Iterable<any>; roots: any[]}
}
