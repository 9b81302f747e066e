"""Simulate sessions without a browser, with the part of Bokeh's WebSocket protocol that dragging, choosing and clicking need."""

from __future__ import annotations

import asyncio
import http.client
import json
import random
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from ipaddress import IPv4Address
from types import MappingProxyType
from typing import Any
from urllib.parse import parse_qsl, urljoin

from tornado.httpclient import AsyncHTTPClient, HTTPClientError
from tornado.simple_httpclient import HTTPTimeoutError

from app.server.admission import RETRY_SECONDS
from engine import Plane
from tests.page_channel import NO_OPTIONS, Channel, Options

CHEAP_ENERGIES = {"I": (0.22, 0.45), "II": (0.22, 0.45), "III": (0.40, 0.90)}
"""Energies well above the escape energy, where a map takes the least time."""

DRAG_SECONDS = 0.4
"""Duration of a drag of the slider."""

POLL_SECONDS = 0.05
# Shortest and longest pause between two actions.
PAUSE_SECONDS = 1.0, 5.0
FRAME_TIMEOUT_SECONDS = 30.0
"""Longest permitted wait for a frame; longer waits are errors."""

ANSWER_SECONDS = 60.0
"""Longest permitted wait for the answer to a request."""

ACTIONS = {"slider": 80, "case": 7, "plane": 6, "click": 7}
"""Actions and their weights."""

ALL_ACTIONS = {"slider": 50, "case": 10, "plane": 10, "click": 10, "type": 10, "open": 10}
"""Actions and their weights, including typed formulas and pages opened again."""

# Actions that request a map.
_OF_MAPS = ("slider", "case", "plane")


@dataclass
class Record:
    """Measurements of all sessions; times in seconds.

    Attributes
    ----------
    opening
        Times from the request of a page to its first map.
    waits
        By action, times from the action to the first frame of its map.
    replaced
        Waits in vain, for maps that the next action replaced.
    reviews
        Times from a formula, in a link or typed, to its review on the page.
    clicks, orbit_plots, refused
        Counts; `refused` counts pages that a full server, or a proxy with a limit, did not open.
    errors
        Messages.
    """

    opening: list[float] = field(default_factory=list)
    waits: dict[str, list[float]] = field(default_factory=lambda: {name: [] for name in _OF_MAPS})
    replaced: list[float] = field(default_factory=list)
    reviews: list[float] = field(default_factory=list)
    clicks: int = 0
    orbit_plots: int = 0
    refused: int = 0
    errors: list[str] = field(default_factory=list)


def visitor_headers(name: str, number: int) -> dict[str, str]:
    """Return the header with which a proxy gives a visitor an individual address."""
    return {name: str(IPv4Address("10.0.0.0") + number)}


class SimulatedSession:
    """One session with random actions, of a visitor with an individual address.

    Parameters
    ----------
    address
        Address of the page.
    seed
        Seed of the actions, and number of the visitor's address.
    record
        Receives the measurements.
    options
        Options of all requests.
    actions
        Actions and their weights.
    """

    def __init__(
        self,
        address: str,
        seed: int,
        record: Record,
        options: Options = NO_OPTIONS,
        actions: Mapping[str, int] = MappingProxyType(ACTIONS),
    ) -> None:
        headers = visitor_headers("X-Forwarded-For", seed) | options.get("headers", {})
        self._address, self._options, self._record = address, {**options, "headers": headers}, record
        self._random, self._actions = random.Random(seed), actions
        self._channel: Channel | None = None
        self._models: dict[str, str] = {}
        self._case, self._plane = "I", Plane.X_PX
        # The action whose map is awaited, and the time of the action.
        self._awaited: tuple[str, float] | None = None
        # Parameters of the page's address after the awaited action, and whether the address has these parameters.
        self._parameters: dict[str, str] = {}
        self._accepted = True
        self._opened = asyncio.Event()
        # The pane that says that a formula is being reviewed, and the event that the text of the pane has changed.
        self._reviewing: str | None = None
        # The formula that was typed last; None after a link.
        self._typed: str | None = None
        self._reviewed = asyncio.Event()
        self._closing = False
        self._steps = 0
        self._reader: asyncio.Task[None] | None = None

    async def open(self) -> None:
        """Load the page and wait for its first map, or count the refusal of a full server."""
        begin = time.perf_counter()
        self._models, self._case, self._plane, self._awaited = {}, "I", Plane.X_PX, None
        self._typed = None
        self._opened.clear()
        if not await self._load(self._address):
            return
        try:
            await asyncio.wait_for(self._opened.wait(), FRAME_TIMEOUT_SECONDS)
            self._record.opening.append(time.perf_counter() - begin)
        except TimeoutError:
            self._record.errors.append(f"no map within {FRAME_TIMEOUT_SECONDS:g} s of opening the page")

    async def open_formula(self, link: str) -> None:
        """Replace this page by that of a link with a formula, and wait until the formula is reviewed."""
        await self.close()
        self._reviewed.clear()
        begin = time.perf_counter()
        if await self._load(self._address + link):
            await self._wait_for_review(begin)

    async def follow_formula(self, link: str) -> None:
        """Show the view of a link with a formula, as the browser's Back does, and wait until the formula is reviewed."""
        self._typed = None
        self._reviewed.clear()
        self.follow_link(link)
        await self._wait_for_review(time.perf_counter())

    async def type_formula(self, text: str, *, done: bool = True) -> None:
        """Type a formula, with Enter if `done`, and wait for its review. The same formula is not reviewed again."""
        if "FormulaBox" not in self._models:
            self.press("Other …")
        while "FormulaBox" not in self._models:
            await asyncio.sleep(POLL_SECONDS)
        if text == self._typed:
            return
        self._typed = text
        self._reviewed.clear()
        self._give("FormulaBox", text, done=done)
        await self._wait_for_review(time.perf_counter())

    def _give(self, component: str, value: Any, *, name: str = "", done: bool = True) -> None:
        """Give an input, or a named value of a component, a value; `done` is False while the visitor still types or drags."""
        self._steps += 1
        entries = [["name", name], ["value", value], ["count", self._steps], ["done", done]]
        self._open_channel.emit("data_event", model={"id": self._models[component]}, data={"type": "map", "entries": entries})

    async def _wait_for_review(self, begin: float) -> None:
        try:
            await asyncio.wait_for(self._reviewed.wait(), FRAME_TIMEOUT_SECONDS)
        except TimeoutError:
            self._record.errors.append(f"no review within {FRAME_TIMEOUT_SECONDS:g} s")
        self._record.reviews.append(time.perf_counter() - begin)

    async def _load(self, address: str) -> bool:
        """Load a page, or count the refusal of a full server; return whether the page is open."""
        self._closing = False
        try:
            self._channel = await Channel.open(address, self._options)
        except HTTPClientError as error:
            if error.code not in (http.client.TOO_MANY_REQUESTS, http.client.SERVICE_UNAVAILABLE):
                raise
            self._record.refused += 1
            return False
        self._reader = asyncio.create_task(self._read(self._channel))
        return True

    async def run(self, end: float) -> None:
        """Act at random until `time.perf_counter()` reaches `end`, then wait for the last map. Without a page, do nothing."""
        while self.is_open:
            pause = self._random.uniform(*PAUSE_SECONDS)
            if time.perf_counter() + pause > end:
                break
            await asyncio.sleep(pause)
            self._check_timeout()
            [action] = self._random.choices(list(self._actions), list(self._actions.values()))
            await getattr(self, f"_act_{action}")()
        deadline = time.perf_counter() + FRAME_TIMEOUT_SECONDS
        while self._awaited is not None and time.perf_counter() < deadline:
            await asyncio.sleep(0.05)
        self._check_timeout()

    async def run_when_admitted(self, end: float) -> None:
        """Ask a full server for the page again, as a refused page does, and act until `end` once the page is open."""
        while not self.is_open and time.perf_counter() + RETRY_SECONDS < end:
            await asyncio.sleep(RETRY_SECONDS)
            await self.open()
        await self.run(end)

    async def close(self) -> None:
        """Close the page."""
        self._closing = True
        if self._channel is not None and self._reader is not None:
            self._channel.close()
            self._reader.cancel()
            await asyncio.wait([self._reader])

    async def drop(self) -> None:
        """Load another page, connect, and close the connection at once; a full server may refuse it."""
        with suppress(HTTPClientError):
            (await Channel.open(self._address, self._options)).close()

    def another(self) -> SimulatedSession:
        """Return another page of this visitor."""
        return SimulatedSession(self._address, self._random.randrange(2**31), self._record, self._options)

    async def stop_reading(self) -> None:
        """Keep the connection, but stop reading from it."""
        self._closing = True
        if self._reader is not None:
            self._reader.cancel()
            await asyncio.wait([self._reader])

    @property
    def is_open(self) -> bool:
        """Whether the page is connected."""
        return self._reader is not None and not self._reader.done()

    async def fetch(self, path: str) -> None:
        """Request a path of the server as another visitor would, and wait for the answer."""
        address = urljoin(self._address, path)
        try:
            await AsyncHTTPClient().fetch(address, raise_error=False, request_timeout=ANSWER_SECONDS, **self._options)
        except HTTPTimeoutError:
            self._record.errors.append(f"no answer within {ANSWER_SECONDS:g} s")

    async def connect(self, token: str) -> None:
        """Open a WebSocket with this token, which the server may refuse, wait for the first message, and close the WebSocket."""
        with suppress(HTTPClientError, EOFError):
            channel = await Channel.connect(self._address, f'"token":"{token}"', self._options)
            await channel.part()
            channel.close()

    def follow_link(self, link: str) -> None:
        """Show the view of a link, as the browser's Back does."""
        self._steps += 1
        entries = [["link", link], ["entry", 0], ["steps", self._steps]]
        model = {"id": self._models["BrowserEvents"]}
        self._open_channel.emit("data_event", model=model, data={"type": "map", "entries": entries})

    def press(self, label: str) -> None:
        """Press a button, if the page has it."""
        if label in self._models:
            self._open_channel.emit("button_click", model={"id": self._models[label]})

    def click(self, x: float, ordinate: float) -> None:
        """Click a point of the map."""
        figure = {"id": self._models["basins"]}
        self._open_channel.emit("tap", model=figure, sx=0.0, sy=0.0, x=x, y=ordinate, modifiers={"type": "map", "entries": []})

    async def _act_slider(self) -> None:
        while self._awaited is not None and self._awaited[0] == "case" and not self._accepted:
            # The slider still has the range of the old case.
            await asyncio.sleep(POLL_SECONDS)
            self._check_timeout()
        low, high = CHEAP_ENERGIES[self._case]
        # Energies between the steps of the slider, so that hardly any map is cached.
        stop = round(self._random.uniform(low, high), 6)
        # During a drag, the browser computes the pictures.
        await asyncio.sleep(DRAG_SECONDS)
        self._await_map("slider", h=repr(stop))
        self._give("BrowserEngine", stop, name="energy")

    async def _act_case(self) -> None:
        cases = list(CHEAP_ENERGIES)
        self._case = self._random.choice([case for case in cases if case != self._case])
        self._await_map("case", case=self._case)
        self._open_channel.set(self._models["Case"], active=cases.index(self._case))

    async def _act_plane(self) -> None:
        planes = list(Plane)
        self._plane = Plane.X_Y if self._plane is Plane.X_PX else Plane.X_PX
        self._await_map("plane", plane=self._plane.key)
        self._open_channel.set(self._models["Plane"], active=planes.index(self._plane))

    async def _act_type(self) -> None:
        # The formula has no exits, so it is reviewed, but the page keeps its maps.
        factors = (self._random.uniform(0.5, 2.0) for _ in range(2))
        await self.type_formula("{:.6f} x² + {:.6f} y²".format(*factors))

    async def _act_open(self) -> None:
        await self.close()
        deadline = time.perf_counter() + FRAME_TIMEOUT_SECONDS
        await self.open()
        while not self.is_open and time.perf_counter() < deadline:
            await asyncio.sleep(1.0)
            await self.open()

    async def _act_click(self) -> None:
        self._record.clicks += 1
        self.click(self._random.uniform(-0.3, 0.3), self._random.uniform(-0.3, 0.3))

    @property
    def _open_channel(self) -> Channel:
        assert self._channel is not None, "open the session first"
        return self._channel

    def _await_map(self, action: str, **parameters: str) -> None:
        """Begin to wait for the map of an action. After the action, the address of the page has these parameters."""
        if self._awaited is not None:
            self._record.replaced.append(time.perf_counter() - self._awaited[1])
        self._awaited, self._parameters, self._accepted = (action, time.perf_counter()), parameters, False

    def _check_timeout(self) -> None:
        if self._awaited is not None and time.perf_counter() - self._awaited[1] > FRAME_TIMEOUT_SECONDS:
            self._record.errors.append(f"no frame within {FRAME_TIMEOUT_SECONDS:g} s of a {self._awaited[0]}")
            self._awaited = None

    async def _read(self, channel: Channel) -> None:
        try:
            async for kind, content in channel.messages():
                self._on_message(kind, content)
        except Exception as error:
            self._record.errors.append(f"{type(error).__name__}: {error}")
        if not self._closing:
            self._record.errors.append("the server closed a socket")

    def _on_message(self, kind: str, content: str) -> None:
        if kind == "ACK":
            self._open_channel.send("PULL-DOC-REQ", {})
        elif kind == "PULL-DOC-REPLY":
            self._models = dict(_named_models(json.loads(content)["doc"]))
            self._open_channel.emit("document_ready")
        elif kind == "ERROR":
            self._record.errors.append(content[:300])
        elif kind == "PATCH-DOC":
            self._on_patch(content)

    def _on_patch(self, content: str) -> None:
        for event in json.loads(content)["events"]:
            model = event.get("model", {}).get("id")
            if event.get("attr") == "address":
                # The address changes when the server accepts the action; earlier pixels belong to an earlier map.
                link = dict(event["new"]["entries"])["link"]
                self._accepted |= self._parameters.items() <= dict(parse_qsl(link.removeprefix("?"))).items()
            if event.get("attr") == "text":
                self._on_text(model, event["new"])
            if event.get("attr") != "data":
                # Sections are rebuilt while the page is open.
                self._models |= dict(_named_models(event))
            elif model in (self._models["maps"], self._models.get("paths")):
                columns = dict(event.get("new", event.get("data"))["entries"])
                if model == self._models["maps"]:
                    self._on_pixels()
                elif columns["xs"]:
                    self._record.orbit_plots += 1

    def _on_text(self, model: str, text: str) -> None:
        """Notice when a formula has been reviewed."""
        if "Reviewing" in text:
            self._reviewing = model
        # If a formula is reviewed at once, only the result is sent to the pane beside the formula.
        elif model in (self._reviewing, self._models.get("potential-message")):
            self._reviewing = None
            self._reviewed.set()

    def _on_pixels(self) -> None:
        """Record the time of the pixels of the awaited map."""
        if not self._opened.is_set():
            self._opened.set()
        elif self._awaited is not None and self._accepted:
            self._record.waits[self._awaited[0]].append(time.perf_counter() - self._awaited[1])
            self._awaited = None


def _named_models(part: Any) -> Iterator[tuple[str, str]]:
    """Yield the names, labels and accessible names of the models of a serialized document, with their ids."""
    if isinstance(part, dict):
        attributes = part.get("attributes")
        if "id" in part and isinstance(attributes, dict):
            names = [
                attributes.get("name"),
                attributes.get("label"),
                dict(attributes.get("html_attributes", {}).get("entries", ())).get("aria-label"),
            ]
            yield from ((name, part["id"]) for name in names if isinstance(name, str))
        part = list(part.values())
    if isinstance(part, list):
        for inner in part:
            yield from _named_models(inner)
