"""Parts of messages that leave at once."""

from __future__ import annotations

import pytest
from bokeh.server import urls
from panel.io.server import WSHandler

from app.bokeh_patches.prompt_sockets import PromptSocket, use_prompt_sockets


def test_panels_sockets_are_replaced_and_nothing_else() -> None:
    patterns: list[tuple[str, type]] = [("/ws", WSHandler), ("/metadata", object)]
    use_prompt_sockets(patterns)
    assert patterns == [("/ws", PromptSocket), ("/metadata", object)]


def test_bokeh_lists_such_a_socket() -> None:
    assert [path for path, handler in urls.per_app_patterns if issubclass(handler, WSHandler)] == ["/ws"]


def test_a_socket_that_opens_waits_with_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[object] = []
    monkeypatch.setattr(WSHandler, "open", lambda self: told.append("open"))
    opening = PromptSocket.__new__(PromptSocket)
    monkeypatch.setattr(opening, "set_nodelay", told.append, raising=False)
    opening.open()
    assert told == [True, "open"]
