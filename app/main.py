"""The page that `panel serve app` serves; `app_hooks` has built it when Bokeh runs this file for a session."""

import panel as pn

if not pn.state.curdoc.roots:
    raise RuntimeError("The page could not be built; the log of the server says why.")
