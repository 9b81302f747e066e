"""Garbage is searched for when nobody waits."""

from __future__ import annotations

import gc
from collections.abc import Iterator

import pytest

from app.server import garbage
from app.server.garbage import SEARCHED_EVERY, Garbage
from tests.test_app.clock import Clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[Clock]:
    made, thresholds = Clock(), gc.get_threshold()
    monkeypatch.setattr(garbage, "time", made)
    yield made
    gc.set_threshold(*thresholds)


def searches() -> int:
    return int(gc.get_stats()[2]["collections"])


def test_it_is_searched_for_once_in_a_while(clock: Clock) -> None:
    search, before = Garbage(lambda: False), searches()
    search.look()
    assert searches() == before
    clock.now += SEARCHED_EVERY
    search.look()
    search.look()
    assert searches() == before + 1


def test_while_somebody_waits_it_is_put_off_but_not_for_ever(clock: Clock) -> None:
    search, before = Garbage(lambda: True), searches()
    clock.now += SEARCHED_EVERY
    search.look()
    assert searches() == before
    clock.now += 9.0 * SEARCHED_EVERY
    search.look()
    assert searches() == before + 1


def test_old_objects_are_not_searched_by_count(clock: Clock) -> None:
    Garbage(lambda: False)
    before = searches()
    kept = [[n] for n in range(400_000)]
    assert searches() == before
    assert len(kept) == 400_000
