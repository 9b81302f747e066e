"""The page that `panel serve app` serves: one explorer for each visitor."""

import panel as pn

from app.session.explorer import Explorer
from app.session.page import explorer_page

LOST = "The connection to the server is lost. Reload this page: its address holds the view."

pn.extension(notifications=True, disconnect_notification=LOST)
explorer_page(Explorer()).servable()
