"""Callbacks and messages stay on the loop's thread."""

from __future__ import annotations

import threading

import pytest
from bokeh.document import Document
from bokeh.server import session
from bokeh.server.session import ServerSession

from app.bokeh_patches.on_the_loop import answer_on_the_loop, call_here
from tests.app.other_loop import run_elsewhere


async def threads_of_callbacks() -> tuple[int, int]:
    """Where a locked callback runs, and where the loop does."""
    made = ServerSession("session", Document())  # type: ignore[arg-type]
    return await made.with_document_locked(threading.get_ident), threading.get_ident()


def test_bokeh_hands_callbacks_to_threads_until_it_is_told_not_to(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(session, "_run_in_executor", session._run_in_executor)
    callback, loop = run_elsewhere(threads_of_callbacks)
    assert callback != loop
    answer_on_the_loop()
    callback, loop = run_elsewhere(threads_of_callbacks)
    assert callback == loop


def test_an_error_reaches_whoever_waits() -> None:
    with pytest.raises(ZeroDivisionError):
        run_elsewhere(lambda: call_here(divmod, 1, 0))
