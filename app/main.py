"""The file that `panel serve app` runs for each session. `app_hooks` has already built the page of the session."""

import panel as pn

if not pn.state.curdoc.roots:
    raise RuntimeError("The page could not be built; the log of the server says why.")
