"""Visitors without a browser: Bokeh's protocol over a WebSocket, as much of it as dragging, choosing and clicking need."""

from __future__ import annotations

import asyncio
import itertools
import json
import random
import re
import time
from collections.abc import AsyncIterator, Iterator
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import parse_qsl

from tornado.httpclient import AsyncHTTPClient
from tornado.websocket import WebSocketClientConnection, websocket_connect

from engine import PREVIEW_SIDE, Plane

CHEAP_ENERGIES = {"I": (0.22, 0.45), "II": (0.22, 0.45), "III": (0.40, 0.90)}
"""Energies well above the escape energy, where a map takes the least time."""

MOVES, MOVE_SECONDS = 8, 0.05
"""A drag: that many places of the slider on its way, one every so many seconds."""

PAUSE_SECONDS = 1.0, 5.0
LONGEST_FRAME_SECONDS = 30.0
"""A visitor whose frame has not come by then counts as one whom the server has failed."""

ACTS = {"slider": 80, "case": 7, "plane": 6, "click": 7}
"""What visitors do, with its weights."""


@dataclass
class Record:
    """What all visitors together went through; times in seconds."""

    opening: list[float] = field(default_factory=list)
    waits: dict[str, list[float]] = field(default_factory=lambda: {name: [] for name in ACTS if name != "click"})
    overtaken: list[float] = field(default_factory=list)
    looks: int = 0
    clicks: int = 0
    drawn: int = 0
    errors: list[str] = field(default_factory=list)


class Channel:
    """One WebSocket that speaks Bokeh's protocol."""

    def __init__(self, socket: WebSocketClientConnection) -> None:
        self._socket = socket
        self._numbers = itertools.count()

    @classmethod
    async def open(cls, address: str) -> Channel:
        """Fetch the page, and connect with the token in it."""
        page = await AsyncHTTPClient().fetch(address, request_timeout=60.0)
        return await cls.connect(address, page.body.decode())

    @classmethod
    async def connect(cls, address: str, page: str) -> Channel:
        """Connect with the token in a page that has been fetched."""
        token = re.search(r'"token":"([^"]+)"', page)
        if token is None:
            raise RuntimeError("the page has no token")
        socket = await websocket_connect(re.sub("^http", "ws", address) + "/ws", subprotocols=["bokeh", token[1]])
        # As browsers do.
        socket.protocol.set_nodelay(True)
        return cls(socket)

    def send(self, kind: str, content: dict[str, Any]) -> None:
        header = {"msgid": f"visitor-{next(self._numbers)}", "msgtype": kind}
        for part in (header, {}, content):
            self._socket.write_message(json.dumps(part))

    def patch(self, event: dict[str, Any]) -> None:
        self.send("PATCH-DOC", {"events": [event]})

    def set(self, model: str, **values: Any) -> None:
        """Change a model's attributes, as its view in the browser does."""
        events = [{"kind": "ModelChanged", "model": {"id": model}, "attr": name, "new": value} for name, value in values.items()]
        self.send("PATCH-DOC", {"events": events})

    def tell(self, name: str, **values: Any) -> None:
        """Report an event of the page."""
        entries = [[key, value] for key, value in values.items()]
        data = {"type": "event", "name": name, "values": {"type": "map", "entries": entries}}
        self.patch({"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": data})

    async def messages(self) -> AsyncIterator[tuple[str, str]]:
        """Kind and content of what the server says, until the socket closes; pixels are let go by."""
        try:
            while True:
                header, _, content = [await self._part() for _ in range(3)]
                header = json.loads(header)
                for _ in range(2 * header.get("num_buffers", 0)):
                    await self._part()
                yield header["msgtype"], content
        except EOFError:
            return

    async def _part(self) -> Any:
        # A socket that closes says None once, and then nothing.
        part = await self._socket.read_message()
        if part is None:
            raise EOFError
        return part

    def close(self) -> None:
        self._socket.close()


class JobClient:
    """One session, from its page to its end."""

    def __init__(self, address: str, seed: int, record: Record) -> None:
        self._address, self._record = address, record
        self._random = random.Random(seed)
        self._channel: Channel | None = None
        self._models: dict[str, str] = {}
        self._case, self._plane = "I", Plane.X_PX
        self._asked: tuple[str, float] | None = None
        self._wish: dict[str, str] = {}
        self._begun = True
        self._here = asyncio.Event()
        self._leaving = False
        self._reading: asyncio.Task[None] | None = None

    async def open(self) -> None:
        """Load the page and wait for its first map."""
        begin = time.perf_counter()
        self._channel = await Channel.open(self._address)
        self._reading = asyncio.create_task(self._read(self._channel))
        try:
            await asyncio.wait_for(self._here.wait(), LONGEST_FRAME_SECONDS)
            self._record.opening.append(time.perf_counter() - begin)
        except TimeoutError:
            self._record.errors.append(f"no map within {LONGEST_FRAME_SECONDS:g} s of opening the page")

    async def stay(self, end: float) -> None:
        """Do this and that until `time.perf_counter()` says `end`."""
        while True:
            pause = self._random.uniform(*PAUSE_SECONDS)
            if time.perf_counter() + pause > end:
                break
            await asyncio.sleep(pause)
            self._check_patience()
            [act] = self._random.choices(list(ACTS), list(ACTS.values()))
            await getattr(self, f"_act_{act}")()
        last = time.perf_counter() + LONGEST_FRAME_SECONDS
        while self._asked is not None and time.perf_counter() < last:
            await asyncio.sleep(0.05)
        self._check_patience()

    async def leave(self) -> None:
        """Close the page."""
        self._leaving = True
        if self._channel is not None and self._reading is not None:
            self._channel.close()
            self._reading.cancel()
            await asyncio.wait([self._reading])

    async def _act_slider(self) -> None:
        low, high = CHEAP_ENERGIES[self._case]
        # Off the slider's steps, so that hardly any map has been computed before.
        start, stop = (round(self._random.uniform(low, high), 6) for _ in range(2))
        for move in range(1, MOVES + 1):
            self._open_channel.set(self._models["Energy h"], value=start + (stop - start) * move / MOVES)
            await asyncio.sleep(MOVE_SECONDS)
        self._ask("slider", h=repr(stop))
        self._open_channel.set(self._models["Energy h"], value=stop, value_throttled=stop)

    async def _act_case(self) -> None:
        cases = list(CHEAP_ENERGIES)
        self._case = self._random.choice([case for case in cases if case != self._case])
        self._ask("case", case=self._case)
        self._open_channel.set(self._models["Case"], value=self._case, active=cases.index(self._case))

    async def _act_plane(self) -> None:
        planes = list(Plane)
        self._plane = Plane.X_Y if self._plane is Plane.X_PX else Plane.X_PX
        self._ask("plane", plane=self._plane.name.lower())
        self._open_channel.set(self._models["Plane"], value=self._plane.value, active=planes.index(self._plane))

    async def _act_click(self) -> None:
        x, y = (self._random.uniform(-0.3, 0.3) for _ in range(2))
        self._record.clicks += 1
        figure = {"id": self._models["basins"]}
        self._open_channel.tell("tap", model=figure, sx=0.0, sy=0.0, x=x, y=y, modifiers={"type": "map", "entries": []})

    @property
    def _open_channel(self) -> Channel:
        assert self._channel is not None, "a visitor opens the page first"
        return self._channel

    def _ask(self, act: str, **wish: str) -> None:
        """From now on a map is waited for; `wish` is what the page's address then says of it."""
        if self._asked is not None:
            self._record.overtaken.append(time.perf_counter() - self._asked[1])
        self._asked, self._wish, self._begun = (act, time.perf_counter()), wish, False

    def _check_patience(self) -> None:
        if self._asked is not None and time.perf_counter() - self._asked[1] > LONGEST_FRAME_SECONDS:
            self._record.errors.append(f"no frame within {LONGEST_FRAME_SECONDS:g} s of a {self._asked[0]}")
            self._asked = None

    async def _read(self, channel: Channel) -> None:
        try:
            async for kind, content in channel.messages():
                self._hear(kind, content)
        except Exception as error:
            self._record.errors.append(f"{type(error).__name__}: {error}")
        if not self._leaving:
            self._record.errors.append("the server closed a socket")

    def _hear(self, kind: str, content: str) -> None:
        if kind == "ACK":
            self._open_channel.send("PULL-DOC-REQ", {})
        elif kind == "PULL-DOC-REPLY":
            self._models = dict(_named_models(json.loads(content)["doc"]))
            self._open_channel.tell("document_ready")
        elif kind == "ERROR":
            self._record.errors.append(content[:300])
        elif kind == "PATCH-DOC":
            self._hear_patch(content)

    def _hear_patch(self, content: str) -> None:
        for event in json.loads(content)["events"]:
            model = event.get("model", {}).get("id")
            if event.get("attr") == "search":
                # The address changes as the page takes a request: pixels that come before belong to the last one.
                self._begun |= self._wish.items() <= dict(parse_qsl(event["new"].removeprefix("?"))).items()
            if event.get("attr") == "data" and model in (self._models["maps"], self._models["paths"]):
                columns = dict(event.get("new", event.get("data"))["entries"])
                if model == self._models["maps"]:
                    self._see(columns)
                elif columns["xs"]:
                    self._record.drawn += 1

    def _see(self, columns: dict[str, Any]) -> None:
        """Pixels: of a quick look, or of the map that is waited for."""
        if columns["fate"][0]["shape"][0] == PREVIEW_SIDE:
            self._record.looks += 1
        elif not self._here.is_set():
            self._here.set()
        elif self._asked is not None and self._begun:
            self._record.waits[self._asked[0]].append(time.perf_counter() - self._asked[1])
            self._asked = None


def _named_models(part: Any) -> Iterator[tuple[str, str]]:
    """Labels or names of models in a document, with their ids."""
    if isinstance(part, dict):
        attributes = part.get("attributes") or {}
        for key in ("name", "label"):
            if "id" in part and isinstance(attributes, dict) and isinstance(attributes.get(key), str):
                yield attributes[key], part["id"]
        part = list(part.values())
    if isinstance(part, list):
        for inner in part:
            yield from _named_models(inner)
