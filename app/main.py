"""The file that `panel serve app` runs for each session, whose page `app_hooks` has built before."""

import panel as pn

if not pn.state.curdoc.roots:
    raise RuntimeError("The page could not be built; the log of the server says why.")
