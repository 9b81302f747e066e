"""GarbagePolicy is searched for when nobody waits."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from weakref import ref

import pytest

from app.server import gc_policy
from app.server.gc_policy import QUIET_SECONDS, SEARCHED_EVERY, GarbagePolicy
from tests.app.clock import Clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[Clock]:
    made, thresholds = Clock(), gc.get_threshold()
    monkeypatch.setattr(gc_policy, "time", made)
    yield made
    gc.set_threshold(*thresholds)
    gc.unfreeze()


def searches() -> int:
    return int(gc.get_stats()[2]["collections"])


def test_it_is_searched_for_once_in_a_while(clock: Clock) -> None:
    search, before = GarbagePolicy(lambda: False), searches()
    search.look()
    assert searches() == before
    clock.now += SEARCHED_EVERY
    search.look()
    search.look()
    assert searches() == before + 1


def test_while_somebody_waits_it_is_put_off_but_not_for_ever(clock: Clock) -> None:
    search, before = GarbagePolicy(lambda: True), searches()
    clock.now += SEARCHED_EVERY
    search.look()
    assert searches() == before
    clock.now += 9.0 * SEARCHED_EVERY
    search.look()
    assert searches() == before + 1


def test_a_moment_without_anybody_is_not_quiet(clock: Clock) -> None:
    waited = [True]
    search, before = GarbagePolicy(lambda: waited[0]), searches()
    clock.now += SEARCHED_EVERY
    search.look()
    waited[0] = False
    clock.now += 0.9 * QUIET_SECONDS
    search.look()
    assert searches() == before
    clock.now += 0.2 * QUIET_SECONDS
    search.look()
    assert searches() == before + 1


def test_what_lasts_is_left_out_of_searches_by_others_and_found_by_ours(clock: Clock) -> None:
    class Loop:
        def __init__(self) -> None:
            self.itself = self

    search = GarbagePolicy(lambda: False)
    left = ref(Loop())
    clock.now += 31.0
    search.look()
    gc.collect()
    assert left() is not None
    clock.now += SEARCHED_EVERY
    search.look()
    assert left() is None


def test_old_objects_are_not_searched_by_count(clock: Clock) -> None:
    GarbagePolicy(lambda: False)
    before = searches()
    kept = [[n] for n in range(400_000)]
    assert searches() == before
    assert len(kept) == 400_000
