"""The routes that the page and the operator need; all others are refused before their handlers see the request.

Bokeh and Panel mount more: ``autoload.js`` creates sessions, and ``components`` imports the module that the address names.
"""

from __future__ import annotations

from bokeh.server.tornado import BokehTornado

from app.browser.module_files import ROUTE as MODULES
from app.server.endpoints import ROUTES, NotFound
from app.server.link_pictures import ROUTE as PICTURE

# Tornado fails to look for a file with a null character in its name.
_FILES = "/static/(?!.*%00).*"

OF_PAGE = ("", "/ws", PICTURE, _FILES)
"""Routes below the path of a page: the page, its WebSocket, its picture and its files."""

OF_SERVER = ("/?", _FILES, MODULES[0], *(path for path, _ in ROUTES))
"""Routes below the server's prefix: the redirect to the page, scripts, styles and modules, and what the operator calls."""

_ICON = "/favicon.ico"


def served_routes(application: BokehTornado) -> list[str]:
    """Return the patterns of all paths that are served, with those of a login if there is one."""
    pages = [path.rstrip("/") for path in application.app_paths]
    logins = [path for path, *_ in application.auth_provider.endpoints]
    paths = [*(page + route for page in pages for route in OF_PAGE), *OF_SERVER, *logins]
    return [_ICON, *(application.prefix + path for path in paths)]


def refuse_other_routes(application: BokehTornado) -> None:
    """Answer all other paths with status 404."""
    # Tornado asks handlers that were added later first.
    application.add_handlers(".*", [(f"(?!(?:{'|'.join(served_routes(application))})$).*", NotFound)])
