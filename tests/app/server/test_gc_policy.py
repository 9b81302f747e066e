"""Full garbage collections run when the process is idle."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from weakref import ref

import pytest

from app.server import gc_policy
from app.server.gc_policy import COLLECT_SECONDS, IDLE_SECONDS, GarbagePolicy
from tests.app.clock import Clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[Clock]:
    made, thresholds = Clock(), gc.get_threshold()
    monkeypatch.setattr(gc_policy, "time", made)
    yield made
    gc.set_threshold(*thresholds)
    gc.unfreeze()


def collections() -> int:
    return int(gc.get_stats()[2]["collections"])


def test_collection_runs_once_per_interval(clock: Clock) -> None:
    policy, before = GarbagePolicy(lambda: False), collections()
    policy.check()
    assert collections() == before
    clock.now += COLLECT_SECONDS
    policy.check()
    policy.check()
    assert collections() == before + 1


def test_collection_is_postponed_while_busy_but_not_forever(clock: Clock) -> None:
    policy, before = GarbagePolicy(lambda: True), collections()
    clock.now += COLLECT_SECONDS
    policy.check()
    assert collections() == before
    clock.now += 9.0 * COLLECT_SECONDS
    policy.check()
    assert collections() == before + 1


def test_idle_means_some_seconds_without_activity(clock: Clock) -> None:
    busy = [True]
    policy, before = GarbagePolicy(lambda: busy[0]), collections()
    clock.now += COLLECT_SECONDS
    policy.check()
    busy[0] = False
    clock.now += 0.9 * IDLE_SECONDS
    policy.check()
    assert collections() == before
    clock.now += 0.2 * IDLE_SECONDS
    policy.check()
    assert collections() == before + 1


def test_old_objects_are_exempt_from_collections_of_others(clock: Clock) -> None:
    class Loop:
        def __init__(self) -> None:
            self.itself = self

    policy = GarbagePolicy(lambda: False)
    garbage = ref(Loop())
    clock.now += 31.0
    policy.check()
    gc.collect()
    assert garbage() is not None
    clock.now += COLLECT_SECONDS
    policy.check()
    assert garbage() is None


def test_old_objects_are_not_collected_by_count(clock: Clock) -> None:
    GarbagePolicy(lambda: False)
    before = collections()
    objects = [[n] for n in range(400_000)]
    assert collections() == before
    assert len(objects) == 400_000
