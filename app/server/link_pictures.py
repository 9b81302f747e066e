"""The picture of a link: its address in the head of a page, and the endpoint that computes it for whoever asks."""

from __future__ import annotations

import asyncio
import http.client
from typing import Any
from urllib.parse import urlencode

from bokeh.server.views.auth_request_handler import AuthRequestHandler
from panel.io.server import LoginUrlMixin
from tornado.httputil import HTTPServerRequest
from tornado.web import authenticated

from app.job_clients.link_picture_jobs import NotCompiledError, PngFile, link_picture_job, result_of
from app.runtime.page_address import page_address
from app.runtime.process_state import process_state
from app.runtime.visitors import network_of
from app.server.admission import admitted_picture
from app.server.security_headers import SecurityHeaders
from app.state.link_picture import LinkPicture, picture_of
from app.state.permalink import PARAMETERS, read_link

ROUTE = "/picture.png"
"""Path below that of a page."""

NOT_COMPILED = "The integrator of this potential is not compiled. Open the page of the link first."

# Seconds that programs may keep a picture: an address always has the same one.
_KEPT = 86_400


def picture_address(request: HTTPServerRequest) -> str:
    """The absolute address of the picture of a page, from the request for the page."""
    return f"{page_address(request)}{ROUTE}?{urlencode(_parameters(request))}"


class LinkPictureHandler(SecurityHeaders, LoginUrlMixin, AuthRequestHandler):
    """Sends the picture of the link whose parameters the request has, as PNG."""

    _computation: asyncio.Task[PngFile] | None = None

    def initialize(self, **context: Any) -> None:
        """Accept what Bokeh passes to the handlers of a page."""

    @authenticated
    async def get(self) -> None:
        """Answer with the picture; with a sentence and status 400 for an invalid link, 503 for one that needs a compilation."""
        values, problems = read_link(_parameters(self.request))
        if problems:
            self._answer(http.client.BAD_REQUEST, " ".join(problems))
            return
        network = network_of(str(self.request.remote_ip))
        with admitted_picture(network):
            await self._send(picture_of(values), network)

    def on_connection_close(self) -> None:
        """Cancel the computation: nobody waits for the picture."""
        if self._computation is not None:
            self._computation.cancel()

    async def _send(self, picture: LinkPicture, client: str) -> None:
        self._computation = asyncio.create_task(result_of(process_state().jobs, link_picture_job(picture), client))
        await asyncio.wait([self._computation])
        if self._computation.cancelled():
            return
        try:
            file = self._computation.result()
        except ValueError as error:
            self._answer(http.client.BAD_REQUEST, str(error))
        except NotCompiledError:
            self._answer(http.client.SERVICE_UNAVAILABLE, NOT_COMPILED)
        else:
            self.set_header("Content-Type", "image/png")
            self.set_header("Cache-Control", f"max-age={_KEPT}")
            self.write(file.content)

    def _answer(self, status: int, sentence: str) -> None:
        self.set_status(status)
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.write(sentence)


def _parameters(request: HTTPServerRequest) -> dict[str, str]:
    """The parameters of a link in the address of a request."""
    found = {name: request.arguments[name][0] for name in PARAMETERS if name in request.arguments}
    return {name: text.decode(errors="replace") for name, text in found.items()}
