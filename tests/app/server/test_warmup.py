"""Kernels compiled in the background."""

from __future__ import annotations

from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings
from app.server.warmup import prepare_in_background


def fail() -> None:
    raise OSError("no room on the disk")


def test_the_site_is_prepared_after_the_last_step() -> None:
    site, seen = ProcessState(Settings()), []
    prepare_in_background(site, {"one": lambda: seen.append(site.prepared.is_set())}).join(10)
    assert seen == [False]
    assert site.prepared.is_set()


def test_after_a_step_that_fails_the_site_has_failed() -> None:
    site, seen = ProcessState(Settings()), []
    prepare_in_background(site, {"one": fail, "two": lambda: seen.append(2)}).join(10)
    assert site.failed.is_set()
    assert not site.prepared.is_set()
    assert seen == []


def test_a_stop_of_the_server_ends_it_between_two_steps() -> None:
    site, seen = ProcessState(Settings()), []
    prepare_in_background(site, {"one": site.stopping.set, "two": lambda: seen.append(2)}).join(10)
    assert seen == []
