"""The page that `panel serve app` serves: one explorer for each visitor."""

import panel as pn

from app.explorer import Explorer
from app.page import explorer_page

pn.extension(notifications=True)
explorer_page(Explorer()).servable()
