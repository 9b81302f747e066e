"""The routes that the page and the operator need, and the hosts; all others are refused before their handlers see the request.

Bokeh and Panel mount more: ``autoload.js`` creates sessions, and ``components`` imports the module that the address names.
"""

from __future__ import annotations

import http.client
import re

from bokeh.server.tornado import BokehTornado
from bokeh.settings import settings as bokeh_settings
from tornado.web import HTTPError

from app.browser.module_files import ROUTES as MODULES
from app.server.endpoints import ROUTES, NotFound
from app.server.security_headers import SecurityHeaders

# Tornado fails to look for a file with a null character in its name.
_FILES = "/static/(?!.*%00).*"

OF_PAGE = ("", "/ws", _FILES)
"""Routes below the path of a page: the page, its WebSocket and its files."""

OF_SERVER = ("/?", _FILES, *(path for path, *_ in (*MODULES, *ROUTES)))
"""Routes below the server's prefix: the redirect to the page, scripts, styles and modules, and what the operator calls."""

LOOPBACK = ("localhost", "127.0.0.1", "[::1]")
"""Hosts that are always accepted."""

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


class OtherHost(SecurityHeaders):
    """421 for requests to a host that this server does not have."""

    def prepare(self) -> None:
        """Refuse the request."""
        raise HTTPError(http.client.MISDIRECTED_REQUEST, reason="This host must be given by --allow-websocket-origin.")


def accepted_hosts(application: BokehTornado) -> str:
    """The pattern of hosts without their ports: loopback, and those whose pages may open a WebSocket."""
    origins = bokeh_settings.allowed_ws_origin() or application.websocket_origins
    names = {origin.lower().rsplit(":", 1)[0] for origin in origins}
    # In these origins "*" alone stands for any host, and otherwise for a part of one.
    return "|".join(".*" if name == "*" else re.escape(name).replace(r"\*", "[^.]*") for name in sorted({*LOOPBACK, *names}))


def refuse_other_hosts(application: BokehTornado) -> None:
    """Answer requests to other hosts with status 421, as from a page elsewhere whose name was given the address of this server.

    Probes and the collector of metrics may use any host: what they read has no data of visitors.
    """
    operated = "|".join(application.prefix + path for path, _ in ROUTES)
    application.add_handlers(f"(?!(?:{accepted_hosts(application)})$).*", [(f"(?!(?:{operated})$).*", OtherHost)])
