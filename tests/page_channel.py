"""Open the WebSocket of a page without a browser."""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import AsyncIterator, Mapping
from typing import Any

from tornado.httpclient import AsyncHTTPClient, HTTPRequest
from tornado.websocket import WebSocketClientConnection, websocket_connect

from tests.waiting import SECONDS

Options = Mapping[str, Any]
"""Options of Tornado's `HTTPRequest` for the page and its WebSocket, such as headers."""

NO_OPTIONS: Options = {}


class Channel:
    """A WebSocket with Bokeh's protocol."""

    def __init__(self, address: str, socket: WebSocketClientConnection) -> None:
        self.address = address
        self._socket = socket
        self._numbers = itertools.count()

    @classmethod
    async def open(cls, address: str, options: Options = NO_OPTIONS) -> Channel:
        """Fetch the page and connect with its token."""
        page = await AsyncHTTPClient().fetch(address, request_timeout=SECONDS, **options)
        return await cls.connect(address.partition("?")[0], page.body.decode(), options)

    @classmethod
    async def connect(cls, address: str, page: str, options: Options = NO_OPTIONS) -> Channel:
        """Connect with the token of a page that is already fetched."""
        token = re.search(r'"token":"([^"]+)"', page)
        if token is None:
            raise RuntimeError("the page has no token")
        request = HTTPRequest(re.sub("^http", "ws", address) + "/ws", **options)
        socket = await websocket_connect(request, subprotocols=["bokeh", token[1]])
        # Browsers also send small messages without delay.
        socket.protocol.set_nodelay(True)
        return cls(address, socket)

    def send(self, kind: str, content: dict[str, Any]) -> None:
        """Send a message."""
        header = {"msgid": f"simulated-{next(self._numbers)}", "msgtype": kind}
        self.write(*(json.dumps(part) for part in (header, {}, content)))

    def write(self, *parts: str | bytes) -> None:
        """Send parts, which need not form a message."""
        for part in parts:
            self._socket.write_message(part, binary=isinstance(part, bytes))

    def patch(self, event: dict[str, Any]) -> None:
        """Send one event of a document patch."""
        self.send("PATCH-DOC", {"events": [event]})

    def set(self, model: str, **values: Any) -> None:
        """Change attributes of a model, as its view in the browser does."""
        events = [{"kind": "ModelChanged", "model": {"id": model}, "attr": name, "new": value} for name, value in values.items()]
        self.send("PATCH-DOC", {"events": events})

    def emit(self, name: str, **values: Any) -> None:
        """Send an event of a model or of the document."""
        entries = [[key, value] for key, value in values.items()]
        data = {"type": "event", "name": name, "values": {"type": "map", "entries": entries}}
        self.patch({"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": data})

    async def messages(self) -> AsyncIterator[tuple[str, str]]:
        """Yield the kind and content of each message of the server until the socket closes. Binary buffers are skipped."""
        try:
            while True:
                header, _, content = [await self.part() for _ in range(3)]
                header = json.loads(header)
                for _ in range(2 * header.get("num_buffers", 0)):
                    await self.part()
                yield header["msgtype"], content
        except EOFError:
            return

    async def part(self) -> Any:
        """Return the next part of a message."""
        # A closed socket returns None once, and no further message.
        part = await self._socket.read_message()
        if part is None:
            raise EOFError
        return part

    def close(self) -> None:
        self._socket.close()
