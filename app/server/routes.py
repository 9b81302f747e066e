"""The routes that the page and the operator need, their handlers, and the accepted hosts. Other routes and hosts are refused.

Bokeh and Panel add more routes, which are refused, such as ``autoload.js``, which creates sessions, and ``components``, which
imports the module that the address names.

The handlers are installed in two documented lists of ``bokeh.server.urls``, from which Bokeh builds its web application
(https://docs.bokeh.org/en/latest/docs/reference/server/urls.html). Panel also adds its handlers there. The lists are the only
public way to reach the handlers of ``panel serve`` without a command line option: lifecycle hooks get no reference to the web
application, which already exists when the hooks run. Bokeh and Panel add other handlers elsewhere: for ``/favicon.ico`` and
``/app/static``, which are replaced, and for Panel's login pages.
"""

from __future__ import annotations

import asyncio
import http.client
import re
import secrets
from typing import Any

from bokeh.server.tornado import BokehTornado
from bokeh.server.views.ico_handler import IcoHandler
from bokeh.settings import settings as bokeh_settings
from panel.io.server import DocHandler, RootHandler, WSHandler
from tornado.web import Finish, HTTPError, RedirectHandler, StaticFileHandler

from app.browser.module_files import ROUTES as MODULE_ROUTES
from app.runtime.process_state import process_state
from app.runtime.visitors import network_of
from app.server.admission import LONGEST_PAGE_WAIT, RETRIED_STATUSES, RETRY_SECONDS, refusal_page, refuse_after_wait
from app.server.compressed_files import CompressedFiles
from app.server.endpoints import ROUTES as ENDPOINT_ROUTES
from app.server.endpoints import NotFound
from app.server.page_websocket import PageWebSocket
from app.server.security_headers import SecurityHeaders, add_nonce
from app.server.session_tokens import issue_token, use_token

# Tornado fails when it looks for a file with a null character in its name.
_FILES = "/static/(?!.*%00).*"

PAGE_ROUTES = ("", "/ws", _FILES)
"""Routes below the path of a page: the page itself, its WebSocket and its files."""

SERVER_ROUTES = ("/?", _FILES, *(path for path, *_ in (*MODULE_ROUTES, *ENDPOINT_ROUTES)))
"""Routes below the server's prefix: the redirect to the page, scripts, styles, modules, and the endpoints for the operator."""

LOOPBACK = ("localhost", "127.0.0.1", "[::1]")
"""Hosts that are always accepted."""

_ICON = "/favicon.ico"


def served_routes(application: BokehTornado) -> list[str]:
    """Return the patterns of all served paths, including the paths of a login."""
    pages = [path.rstrip("/") for path in application.app_paths]
    logins = [path for path, *_ in application.auth_provider.endpoints]
    paths = [*(page + route for page in pages for route in PAGE_ROUTES), *SERVER_ROUTES, *logins]
    return [_ICON, *(application.prefix + path for path in paths)]


def refuse_other_routes(application: BokehTornado) -> None:
    """Answer all paths but the served paths with status 404."""
    # Tornado tries the last added handlers first.
    application.add_handlers(".*", [(f"(?!(?:{'|'.join(served_routes(application))})$).*", NotFound)])


def secure_other_files(application: BokehTornado) -> None:
    """Serve the icon and the files beside the page with security headers."""
    files = [
        (f"{application.prefix}{path.rstrip('/')}/static/(.*)", _secured(StaticFileHandler), {"path": static_path})
        for path, context in application.applications.items()
        if (static_path := context.application.static_path) is not None
    ]
    application.add_handlers(".*", [*files, (_ICON, _secured(IcoHandler), {"app": application})])


class PageRedirect(SecurityHeaders, RedirectHandler):
    """Redirects from the root to the page, with the query of the link."""


def redirect_to_page(application: BokehTornado) -> None:
    """Redirect the root to the page of the server's only application. Bokeh's own redirect drops the query."""
    paths = list(application.app_paths)
    if len(paths) == 1:
        # A relative address, because a proxy may have removed a part of the path.
        redirect_options = {"url": f".{paths[0]}", "permanent": False}
        application.add_handlers(".*", [(f"{application.prefix}/", PageRedirect, redirect_options)])


class HostRefusal(SecurityHeaders):
    """Answers 421 to requests for a host that is not accepted."""

    def prepare(self) -> None:
        """Refuse the request."""
        raise HTTPError(http.client.MISDIRECTED_REQUEST, reason="This host is not accepted; --allow-websocket-origin adds it.")


def accepted_hosts(application: BokehTornado) -> str:
    """Return the pattern of accepted hosts, without ports: loopback, and the hosts whose pages may open a WebSocket."""
    origins = bokeh_settings.allowed_ws_origin() or application.websocket_origins
    names = {origin.lower().rsplit(":", 1)[0] for origin in origins}
    # A lone "*" stands for any host. Within a name, "*" stands for a part between dots.
    return "|".join(".*" if name == "*" else re.escape(name).replace(r"\*", "[^.]*") for name in sorted({*LOOPBACK, *names}))


def refuse_other_hosts(application: BokehTornado) -> None:
    """Answer requests to other hosts with status 421: a foreign page could let its host name point here (DNS rebinding).

    Probes and the collector of metrics may use any host, because the answers to them contain no data of visitors.
    """
    operator_paths = "|".join(application.prefix + path for path, _ in ENDPOINT_ROUTES)
    application.add_handlers(f"(?!(?:{accepted_hosts(application)})$).*", [(f"(?!(?:{operator_paths})$).*", HostRefusal)])


class PageHandler(SecurityHeaders, DocHandler):
    """Serves the page with a nonce on its scripts and a signed token of its session.

    Pages are made one at a time. Bokeh would make all waiting pages in one iteration of the event loop. Meanwhile, it would serve
    nobody else, and it might discard the first page as unused before sending it. A visitor who has used more than a fair share
    of the server's time waits. A page that has waited for `LONGEST_PAGE_WAIT` is refused, and the browser requests it again.
    """

    _visitor_has_left = False

    async def get_session(self) -> Any:
        """Create a session with a new token, unless the server is full when this page's turn comes."""
        visitor = network_of(str(self.request.remote_ip))
        try:
            async with asyncio.timeout(LONGEST_PAGE_WAIT) as wait:
                return await self._make_session_in_turn(visitor, wait)
        except TimeoutError:
            if not wait.expired():
                raise
            refuse_after_wait()

    async def _make_session_in_turn(self, visitor: str, wait: asyncio.Timeout) -> Any:
        state = process_state()
        while True:
            await asyncio.sleep(state.delay(visitor))
            async with state.making_page.turn(visitor):
                if self._visitor_has_left:
                    raise Finish
                # Other pages of the visitor may have had their turns in the meantime.
                if not state.delay(visitor):
                    # Only the wait is limited.
                    wait.reschedule(None)
                    return await self._make_session(visitor)

    async def _make_session(self, visitor: str) -> Any:
        # The hook of `app_hooks` raises an HTTPError if the server is full.
        payload = self.application_context.application.process_request(self.request)
        use_token(self.request, issue_token(self.application, self.request, payload))
        session = await super().get_session()
        await process_state().next_turn(visitor)
        return session

    def on_connection_close(self) -> None:
        """Make no page for a visitor who has left."""
        self._visitor_has_left = True
        super().on_connection_close()

    def write_error(self, status_code: int, **kwargs: Any) -> None:
        """Answer with the reason. A page that may be served later is requested again by the browser."""
        error = kwargs.get("exc_info", (None, None))[1]
        if status_code not in RETRIED_STATUSES or not isinstance(error, HTTPError):
            super().write_error(status_code, **kwargs)
            return
        self.set_header("Retry-After", RETRY_SECONDS)
        self.finish(refusal_page(error.reason or ""))

    def write(self, chunk: Any) -> None:
        """Write a response. A page contains the nonce and is sent with the matching policy."""
        if isinstance(chunk, str):
            nonce = secrets.token_urlsafe(16)
            self.set_security_headers(nonce)
            chunk = add_nonce(chunk, nonce)
        super().write(chunk)


def install_handlers(per_app_patterns: list[Any], toplevel_patterns: list[Any]) -> None:
    """Add security headers to the handlers in the lists, and append the server's own routes. A second call has no effect.

    Parameters
    ----------
    per_app_patterns, toplevel_patterns
        The lists in `bokeh.server.urls`: tuples of a path, a handler and, optionally, its arguments.
    """
    for patterns in (per_app_patterns, toplevel_patterns):
        patterns[:] = [(path, _secured(handler), *rest) for path, handler, *rest in patterns]
    own_routes = [*ENDPOINT_ROUTES, *((path, _secured(handler), arguments) for path, handler, arguments in MODULE_ROUTES)]
    is_installed = any(path == own_routes[0][0] for path, *_ in toplevel_patterns)
    if not is_installed:
        toplevel_patterns += own_routes


def _secured(handler: type) -> type:
    """Return a handler class that also sets security headers and, for static files, compresses them."""
    # Bokeh recognises the root handler by identity.
    if handler is RootHandler or issubclass(handler, SecurityHeaders):
        return handler
    replacements: dict[type, type] = {DocHandler: PageHandler, WSHandler: PageWebSocket}
    if handler in replacements:
        return replacements[handler]
    mixins = (SecurityHeaders, CompressedFiles) if issubclass(handler, StaticFileHandler) else (SecurityHeaders,)
    return type(f"Secured{handler.__name__}", (*mixins, handler), {})
