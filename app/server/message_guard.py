"""Checks of the messages of one WebSocket before Bokeh gets them: their form, size and number, and what they change."""

from __future__ import annotations

import json
import reprlib
import time
from collections.abc import Callable
from typing import Any

from bokeh.document import Document
from bokeh.model import Model

from app.server.browser_rules import OutdatedMessageError, RefusedMessageError, check_patch, find_choices

LARGEST_FRAGMENT = 4 * 2**20
"""Size limit of a part of a message, in bytes. Most have less than 2 kB; models that the server has added are sent whole."""

MOST_BUFFERS = 64
"""Largest number of binary parts of a message: the arrays of such a model."""

MESSAGES_PER_SECOND, MOST_AT_ONCE = 400.0, 4000
"""Rate limit of the messages of a connection; fast drags on a screen with 144 frames per second send 300 per second."""

REFUSED_COUNTS = 40
"""Number of messages that a refused one counts as, because it causes a line in the log. The page itself sends none."""

BYTES_PER_MESSAGE = 16 * 1024
"""A part of a message counts as one additional message for each of these bytes."""

# Header, metadata and content, then a header and a payload for each buffer.
_PARTS, _PARTS_OF_BUFFER = 3, 2


class UnacceptableConnectionError(Exception):
    """The connection must be closed; one sentence with the reason."""


class MessageGuard:
    """Collects the parts of messages, and passes on the messages that a page sends.

    Parameters
    ----------
    clock
        Seconds of a monotonic clock.

    Attributes
    ----------
    choices
        Result of `find_choices` for the last message.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._parts: list[str | bytes] = []
        self._expected = _PARTS
        self._pulled = False
        self.choices: list[tuple[Model, str]] = []
        self._left, self._last = float(MOST_AT_ONCE), clock()

    def take(self, part: str | bytes, document: Document) -> list[str | bytes]:
        """Take a part of a message.

        Returns
        -------
        The parts of the message if this was the last one, otherwise an empty list.

        Raises
        ------
        RefusedMessageError
            If the message must be ignored.
        UnacceptableConnectionError
            If the connection must be closed because of invalid parts, too many messages or refusals.
        """
        is_payload = len(self._parts) > _PARTS and (len(self._parts) - _PARTS) % _PARTS_OF_BUFFER
        if isinstance(part, str) == bool(is_payload):
            raise UnacceptableConnectionError("a message with binary parts in the wrong places")
        self._count(len(part) / BYTES_PER_MESSAGE)
        if not self._parts:
            self._expected = _PARTS + _PARTS_OF_BUFFER * _count_buffers(part)
        self._parts.append(part)
        if len(self._parts) < self._expected:
            return []
        parts, self._parts = self._parts, []
        self._count(1.0)
        try:
            self._check(_parse(parts[0]), _parse(parts[2]), document)
        except OutdatedMessageError:
            return []
        except RefusedMessageError:
            self._count(REFUSED_COUNTS)
            raise
        return parts

    def _count(self, messages: float) -> None:
        """Refill the reserve by the time since the last message, and take from it."""
        now = self._clock()
        self._left = min(self._left + MESSAGES_PER_SECOND * (now - self._last), MOST_AT_ONCE) - messages
        self._last = now
        if self._left < 0.0:
            raise UnacceptableConnectionError(
                f"more than {MESSAGES_PER_SECOND:g} messages per second, of which each invalid one counts as {REFUSED_COUNTS}"
            )

    def _check(self, header: Any, content: Any, document: Document) -> None:
        kind, self.choices = header["msgtype"], []
        if kind == "PATCH-DOC":
            check_patch(content, document)
            self.choices = find_choices(content, document)
        elif kind == "PULL-DOC-REQ" and not self._pulled:
            self._pulled = True
        elif kind != "SERVER-INFO-REQ":
            raise RefusedMessageError(f"a message {reprlib.repr(kind)} that no page sends")


_LONGEST_NAME = 200


def _count_buffers(part: str | bytes) -> int:
    """The number of buffers that a header announces."""
    header = _parse(part)
    match header:
        case {"msgid": str(number), "msgtype": str()} if len(number) <= _LONGEST_NAME:
            count = header.get("num_buffers", 0)
            if isinstance(count, int) and 0 <= count <= MOST_BUFFERS:
                return count
    raise UnacceptableConnectionError(f"a message with the header {reprlib.repr(header)}")


def _parse(part: str | bytes) -> Any:
    try:
        return json.loads(part)
    except (ValueError, RecursionError):
        raise UnacceptableConnectionError(f"a message with the part {reprlib.repr(part)}, which is not JSON") from None
