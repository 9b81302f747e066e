"""The page that `panel serve app` serves: one explorer for each visitor."""

import panel as pn

from app.explorer import Explorer

pn.extension(notifications=True)
Explorer().layout().servable()
