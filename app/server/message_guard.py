"""Checks of the messages of a WebSocket before Bokeh gets them: their form, size, rate and changes."""

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
"""Largest size of a part of a message, in bytes. Most parts have less than 2 kB, but a browser sends some models whole."""

MOST_BUFFERS = 64
"""Largest number of binary buffers of a message, such as the arrays of a model that is sent whole."""

MESSAGES_PER_SECOND = 400.0
"""Largest rate of the messages of a connection in the long run. Fast drags on a screen with 144 frames per second send 300."""

LARGEST_BURST = 4000
"""Largest number of messages at once, after a pause in which none were sent."""

REFUSAL_WEIGHT = 40
"""A refused message counts as this many messages, because it causes a line in the log. The page sends no such messages."""

BYTES_PER_MESSAGE = 16 * 1024
"""Number of bytes of a part of a message that count as one more message."""

# Number of parts before the buffers: header, metadata and content.
_PARTS_BEFORE_BUFFERS = 3
# Number of parts of a buffer: header and payload.
_PARTS_PER_BUFFER = 2


class UnacceptableConnectionError(Exception):
    """A violation of the protocol or of the limits, after which the connection must be closed. Its text says which."""


class MessageGuard:
    """Collects the parts of messages, and passes on messages that a page can have sent.

    Parameters
    ----------
    clock
        Monotonic clock, in seconds.

    Attributes
    ----------
    choices
        Result of `find_choices` for the last message.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._parts: list[str | bytes] = []
        self._expected_parts = _PARTS_BEFORE_BUFFERS
        self._has_pulled_document = False
        self.choices: list[tuple[Model, str]] = []
        # Number of messages that the connection may send now.
        self._reserve, self._last_refill = float(LARGEST_BURST), clock()

    @property
    def is_next_part_last(self) -> bool:
        """Whether the next part is the last part of a message, whose content is then checked."""
        return len(self._parts) + 1 == self._expected_parts

    def take(self, part: str | bytes, document: Document) -> list[str | bytes]:
        """Take a part of a message.

        Returns
        -------
        All parts of the message after its last part, otherwise an empty list.

        Raises
        ------
        RefusedMessageError
            If the message must be ignored.
        UnacceptableConnectionError
            If the connection must be closed because of invalid parts, too many messages or refusals.
        """
        # After the first parts, the headers and the payloads of buffers alternate. Only payloads are binary.
        buffer_parts = len(self._parts) - _PARTS_BEFORE_BUFFERS
        is_payload = buffer_parts > 0 and buffer_parts % _PARTS_PER_BUFFER == 1
        if isinstance(part, bytes) != is_payload:
            raise UnacceptableConnectionError("a message with binary parts in the wrong places")
        self._use_reserve(len(part) / BYTES_PER_MESSAGE)
        if not self._parts:
            self._expected_parts = _PARTS_BEFORE_BUFFERS + _PARTS_PER_BUFFER * _count_buffers(part)
        self._parts.append(part)
        if len(self._parts) < self._expected_parts:
            return []
        parts, self._parts = self._parts, []
        self._use_reserve(1.0)
        try:
            self._check(_parse(parts[0]), _parse(parts[2]), document)
        except OutdatedMessageError:
            return []
        except RefusedMessageError:
            self._use_reserve(REFUSAL_WEIGHT)
            raise
        return parts

    def _use_reserve(self, messages: float) -> None:
        """Subtract messages from the reserve, which grows with time; raise an error if the reserve is used up."""
        now = self._clock()
        self._reserve = min(self._reserve + MESSAGES_PER_SECOND * (now - self._last_refill), LARGEST_BURST) - messages
        self._last_refill = now
        if self._reserve < 0.0:
            raise UnacceptableConnectionError(
                f"more than {MESSAGES_PER_SECOND:g} messages per second, of which each invalid one counts as {REFUSAL_WEIGHT}"
            )

    def _check(self, header: Any, content: Any, document: Document) -> None:
        """Refuse a message that no page sends, given its parsed header and content, and find the choices in it."""
        kind, self.choices = header["msgtype"], []
        if kind == "PATCH-DOC":
            check_patch(content, document)
            self.choices = find_choices(content, document)
        elif kind == "PULL-DOC-REQ" and not self._has_pulled_document:
            self._has_pulled_document = True
        elif kind != "SERVER-INFO-REQ":
            raise RefusedMessageError(f"a message {reprlib.repr(kind)} that no page sends")


# Largest length of the identifier of a message, in characters.
_LONGEST_IDENTIFIER = 200


def _count_buffers(part: str | bytes) -> int:
    """Return the number of buffers that the header of a message announces."""
    header = _parse(part)
    match header:
        case {"msgid": str(identifier), "msgtype": str()} if len(identifier) <= _LONGEST_IDENTIFIER:
            count = header.get("num_buffers", 0)
            if isinstance(count, int) and 0 <= count <= MOST_BUFFERS:
                return count
    raise UnacceptableConnectionError(f"a message with the header {reprlib.repr(header)}")


def _parse(part: str | bytes) -> Any:
    try:
        return json.loads(part)
    except (ValueError, RecursionError):
        raise UnacceptableConnectionError(f"a message with the part {reprlib.repr(part)}, which is not JSON") from None
