"""The page that `panel serve app` serves, with an explorer for each session."""

import panel as pn

from app.session.explorer import Explorer
from app.session.page import explorer_page

# Without this call, Panel loads the scripts of all its extensions.
pn.extension()
explorer_page(Explorer()).servable()
