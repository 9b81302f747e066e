"""Callbacks and messages are handled on the event loop."""

from __future__ import annotations

import inspect
import threading

import pytest
from bokeh.document import Document
from bokeh.server import session
from bokeh.server.session import ServerSession
from bokeh.util.asyncio import _run_in_executor

from app.browser.bokeh_patches.inline_callbacks import call_inline, run_callbacks_inline
from tests.app.browser.bokeh_patches.installed_source import missing_hunks
from tests.app.other_loop import run_on_new_loop


async def thread_ids() -> tuple[int, int]:
    """Return the threads of a locked callback and of the event loop."""
    made = ServerSession("session", Document())  # type: ignore[arg-type]
    return await made.with_document_locked(threading.get_ident), threading.get_ident()


def test_callbacks_run_in_a_thread_by_default_and_on_the_loop_with_the_patch(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(session, "_run_in_executor", _run_in_executor)
    callback, loop = run_on_new_loop(thread_ids)
    assert callback != loop
    run_callbacks_inline()
    callback, loop = run_on_new_loop(thread_ids)
    assert callback == loop


def test_errors_are_raised_in_the_caller() -> None:
    with pytest.raises(ZeroDivisionError):
        run_on_new_loop(lambda: call_inline(divmod, 1, 0))


def test_replaced_function_is_unchanged_upstream() -> None:
    assert str(inspect.signature(_run_in_executor)) == "(func: 'Callable[..., T]', *args: 'Any', **kwargs: 'Any') -> 'T'"
    assert inspect.iscoroutinefunction(_run_in_executor)
    assert hasattr(session, "_run_in_executor")


def test_patch_for_upstream_fits_the_installed_bokeh() -> None:
    assert missing_hunks("inline_callbacks.patch") == []
