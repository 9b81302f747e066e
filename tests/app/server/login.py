"""Make a server with a login."""

from __future__ import annotations

from bokeh.application import Application
from bokeh.server.auth_provider import NullAuth
from bokeh.server.tornado import BokehTornado
from tornado.web import RequestHandler


class Login(NullAuth):
    """A login at /login."""

    login_url = "/login"  # type: ignore[assignment]
    login_handler = RequestHandler  # type: ignore[assignment]


def server_with_login(prefix: str = "") -> BokehTornado:
    """Return an application at /app behind a login."""
    return BokehTornado({"/app": Application()}, prefix=prefix, auth_provider=Login())
