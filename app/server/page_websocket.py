"""The WebSocket of a page, which checks the page's token and messages, and closes the connection if they violate the limits."""

from __future__ import annotations

import asyncio
import http.client
import logging
import time
from collections.abc import Awaitable, Sequence
from typing import Any

import panel as pn
from bokeh.document import Document
from bokeh.document.events import ModelChangedEvent
from bokeh.model import Model
from bokeh.protocol.exceptions import ProtocolError
from bokeh.protocol.message import Message
from panel.io.server import WSHandler
from panel.io.state import set_curdoc
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from app.runtime.process_state import process_state
from app.runtime.visitors import network_of, visitor_of
from app.server.admission import check_session, count_socket, forget_socket
from app.server.browser_rules import RefusedMessageError
from app.server.message_guard import LARGEST_FRAGMENT, MessageGuard, UnacceptableConnectionError
from app.server.security_headers import SecurityHeaders
from app.server.session_tokens import has_signed_token
from app.views.components.notice import PASSING_SECONDS, show_passing_notice

DELAYED_NOTICE = "Your pages keep the server busy: what you do next is delayed, so that others are served too."

# Close code of a WebSocket (RFC 6455, 7.4.1).
_POLICY_VIOLATION = 1008

log = logging.getLogger(f"bokeh.{__name__}")


class PageWebSocket(SecurityHeaders, WSHandler):
    """Checks and limits the messages of a page, and sends messages to it without delay.

    A Bokeh message consists of a dozen WebSocket messages. By default, TCP delays all but the first of these until the client has
    acknowledged the first: by a round trip, and up to 40 ms more (Nagle's algorithm with delayed acknowledgements, RFC 1122,
    4.2.3.2 and 4.2.3.4).

    Messages that no page sends are ignored, with a line in the log. Too many or too large messages close the connection.
    Bokeh gets neither kind. While the visitor uses more than a fair share of the event loop's time, messages wait, a notice on
    the page says so, and nothing is read from the socket.
    """

    # Tornado closes the connection if a part of a message is longer than this, in bytes.
    max_message_size = LARGEST_FRAGMENT

    _is_counted = False

    async def prepare(self) -> None:
        """Refuse tokens that this server has not signed, before Bokeh or a login of Panel decompresses them."""
        if has_signed_token(self.application, self.request):
            await WSHandler.prepare(self)
            return
        log.warning("connection refused: its token is not signed by this server")
        self.set_status(http.client.FORBIDDEN, "Reload the page.")
        self.finish()

    def open(self, *args: Any, **kwargs: Any) -> Any:
        """Disable Nagle's algorithm and open the connection."""
        self.set_nodelay(True)
        # `_closed`: no further message is handled. `_has_ended`: Tornado has reported the end of the connection.
        self._guard, self._closed, self._has_ended = MessageGuard(), False, False
        self._writes: list[Awaitable[None]] = []
        self._last_notice = -PASSING_SECONDS
        try:
            address = str(self.request.remote_ip)
            count_socket(address)
            self._is_counted = True
            check_session(self._token, self.application_context, address, self.application)
            return super().open(*args, **kwargs)
        except Exception as error:
            return self._refuse_connection(error)

    async def _async_open(self, token: str) -> None:
        """Open or join the session of a token, or close the connection if Bokeh refuses the token."""
        try:
            await super()._async_open(token)
        except ProtocolError as error:
            self._refuse_connection(error)
        if self._has_ended and self._open_session() is not None:
            # The socket was closed before Bokeh made the connection. Bokeh would keep connection and session for ever.
            super().on_close()

    async def send_message(self, message: Message[Any]) -> None:
        """Write all parts of a message at once, then wait until the socket has accepted them.

        Bokeh would wait after each part, and lock the socket meanwhile. While the socket is locked, Panel postpones changes,
        some of them until the next change: ``panel.io.document._dispatch_msgs`` ends the postponement although new changes have
        arrived.
        """
        await super().send_message(message)
        writes, self._writes = self._writes, []
        for error in await asyncio.gather(*writes, return_exceptions=True):
            if isinstance(error, BaseException) and not isinstance(error, WebSocketClosedError):
                raise error

    async def write_message(self, message: str | bytes | dict[str, Any], binary: bool = False, locked: bool = True) -> None:
        """Begin to write a part of a message. `send_message` waits for the end."""
        self._writes.append(WebSocketHandler.write_message(self, message, binary))

    async def on_message(self, message: str | bytes) -> None:
        """Wait for the visitor's share of time, then pass a part of a message to Bokeh if a page can have sent it."""
        session = self._open_session()
        if session is not None:
            await self._wait_for_share(session)
            await process_state().page_time(session.document).charge_for(self._take_part(message))
        elif self.connection is None and not self._closed:
            self._refuse_connection(UnacceptableConnectionError("a message before the session is open"))

    async def _wait_for_share(self, session: Any) -> None:
        """Wait until the visitor may use more time."""
        visitor = visitor_of(session.document)
        while (seconds := process_state().delay(visitor)) and not self._closed:
            process_state().metrics.messages_delayed.inc()
            if time.monotonic() >= self._last_notice + PASSING_SECONDS:
                self._last_notice = time.monotonic()
                await session.with_document_locked(show_passing_notice, session.document, DELAYED_NOTICE)
            await asyncio.sleep(seconds)

    async def _take_part(self, part: str | bytes) -> None:
        """Pass a message on after its last part, log a refused message, or close the connection."""
        # The check of a message depends on the document, which may change while the page waits for its turn.
        if self._guard.is_next_part_last:
            await process_state().next_turn(network_of(str(self.request.remote_ip)))
        session = self._open_session()
        if self._closed or session is None:
            return
        try:
            parts = self._guard.take(part, session.document)
        except UnacceptableConnectionError as error:
            self._refuse_connection(error)
        except RefusedMessageError as refusal:
            log.warning("message refused: %s", refusal)
        else:
            if parts:
                await self._pass_on(parts, session)

    async def _pass_on(self, parts: Sequence[str | bytes], session: Any) -> None:
        """Pass the parts of a message to Bokeh, then send the choices in it back."""
        for part in parts:
            await super().on_message(part)
        if self._guard.choices:
            await session.with_document_locked(_send_again, session.document, self._guard.choices)

    def on_close(self) -> None:
        """Tell Bokeh that the connection is closed, unless Bokeh has already dropped it."""
        if self._is_counted:
            forget_socket(str(self.request.remote_ip))
        if self.connection is None or self._open_session() is not None:
            super().on_close()
        self._closed = self._has_ended = True

    def _open_session(self) -> Any:
        """Return the session of the connection; None before it is open, and after Bokeh has dropped the connection."""
        try:
            return None if self.connection is None else self.connection.session
        except AssertionError:
            # Only this error shows that Bokeh has dropped the connection.
            return None

    def _refuse_connection(self, error: Exception) -> None:
        log.warning("connection closed: %s", error)
        self._closed = True
        self.close(_POLICY_VIOLATION, "refused")


async def _send_again(document: Document, choices: Sequence[tuple[Model, str]]) -> None:
    """Send choices back to the browser that made them: an older choice from the server may have replaced them there."""
    with set_curdoc(document), pn.io.hold(document):
        for model, name in choices:
            if model.document is document:
                document.callbacks.trigger_on_change(ModelChangedEvent(document, model, name, getattr(model, name)))
