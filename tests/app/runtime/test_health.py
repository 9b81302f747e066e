"""Whether the server should be sent more visitors."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.runtime.health import why_no_entry, why_not_ready
from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings


@pytest.fixture
def site() -> ProcessState:
    ready = ProcessState(Settings(most_sessions=2))
    ready.prepared.set()
    return ready


def test_a_prepared_server_with_room_is_ready(site: ProcessState) -> None:
    assert why_not_ready(site) is None
    assert why_no_entry(site) is None


def test_until_the_kernels_are_compiled_no_more_visitors_are_sent_but_those_who_come_may_wait(site: ProcessState) -> None:
    site.prepared.clear()
    assert why_not_ready(site) == "The integrators are being compiled."
    assert why_no_entry(site) is None


def test_a_failed_preparation_is_told_apart_from_one_under_way(site: ProcessState) -> None:
    site.prepared.clear()
    site.failed.set()
    assert "could not be compiled" in str(why_not_ready(site))


def test_a_full_server_sends_visitors_away(site: ProcessState) -> None:
    site.sessions = lambda: ["one", "two"]
    assert why_not_ready(site) == why_no_entry(site) == "All 2 places are taken. Reload this page in a minute."


def test_a_stopping_server_sends_visitors_away(site: ProcessState) -> None:
    site.stopping.set()
    assert str(why_not_ready(site)).startswith("The server is stopping.")
    assert str(why_no_entry(site)).startswith("The server is stopping.")


def test_above_the_memory_ceiling_no_more_visitors_are_sent(site: ProcessState, monkeypatch: pytest.MonkeyPatch) -> None:
    site.settings = replace(site.settings, memory_ceiling=1000)
    monkeypatch.setattr("app.runtime.health.resident_bytes", lambda: 1001)
    assert why_not_ready(site) == "The server holds 1001 bytes, above ESCAPE_EXPLORER_MEMORY_CEILING=1000."


def test_a_system_that_does_not_tell_the_memory_is_no_objection(site: ProcessState, monkeypatch: pytest.MonkeyPatch) -> None:
    site.settings = replace(site.settings, memory_ceiling=1000)
    monkeypatch.setattr("app.runtime.health.resident_bytes", lambda: None)
    assert why_not_ready(site) is None
