"""The state of a server process."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from bokeh.document import Document

from app.runtime import process_state as module
from app.runtime.process_state import ProcessState, process_state, start_process_state
from app.runtime.settings import Settings

ROOT = Path(__file__).parents[3]


@pytest.fixture
def not_started(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(module, "_started", None)
    return


@pytest.mark.usefixtures("not_started")
def test_first_use_starts_with_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ESCAPE_EXPLORER_MOST_SESSIONS", "7")
    state = process_state()
    assert state.settings.most_sessions == 7
    assert process_state() is state


@pytest.mark.usefixtures("not_started")
def test_explicit_settings_can_be_given_once() -> None:
    state = start_process_state(Settings(most_sessions=3))
    assert process_state() is state
    with pytest.raises(RuntimeError, match="already been started"):
        start_process_state(Settings())


@pytest.mark.usefixtures("not_started")
def test_invalid_environment_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ESCAPE_EXPLORER_THREADS", "0")
    with pytest.raises(ValueError, match="ESCAPE_EXPLORER_THREADS"):
        process_state()


def test_settings_reach_the_jobs() -> None:
    stats = ProcessState(Settings(cache_bytes=1000, most_orbits=2000, threads=3)).jobs.stats()
    assert (stats.cache_limit, stats.orbits_limit, stats.threads) == (1000, 2000, 3)


def test_idle_process_is_not_overloaded() -> None:
    assert not ProcessState().is_overloaded()


def test_delays_of_loop_and_queue_are_added(monkeypatch: pytest.MonkeyPatch) -> None:
    state = ProcessState(Settings(longest_delay=0.5))
    state.load.delay = 0.3
    monkeypatch.setattr(state.jobs, "take_first_frame_wait", lambda: 0.4)
    state.adapt_to_load()
    assert state.overload.delay == pytest.approx(0.7)


def test_one_thread_is_kept_for_first_frames_as_soon_as_one_is_late(monkeypatch: pytest.MonkeyPatch) -> None:
    state, kept, wait = ProcessState(Settings(longest_delay=0.5)), list[bool](), [0.1, 0.6, 0.1]
    monkeypatch.setattr(state.jobs, "take_first_frame_wait", lambda: wait.pop(0))
    monkeypatch.setattr(state.jobs, "spare_first_frames", kept.append)
    for _ in range(3):
        state.adapt_to_load()
    assert kept == [False, True, True]
    assert not state.overload.is_overloaded()


def test_each_document_has_its_share() -> None:
    state, first, second = ProcessState(), Document(), Document()
    assert state.fair_share(first) is state.fair_share(first)
    assert state.fair_share(first) is not state.fair_share(second)
