"""The cache evicts the least recently used results to keep its limit of memory."""

from __future__ import annotations

from types import SimpleNamespace

from engine.jobs.cache import ResultCache


def sized(nbytes: int) -> SimpleNamespace:
    return SimpleNamespace(nbytes=nbytes)


def test_least_recently_used_results_are_evicted() -> None:
    cache = ResultCache(100)
    for key in ("a", "b", "c"):
        cache.put(key, sized(40))
        cache.get("a")
    assert cache.nbytes == 80
    assert set(cache) == {"a", "c"}


def test_iteration_continues_while_results_are_stored() -> None:
    cache = ResultCache(100)
    cache.put("a", sized(40))
    keys = iter(cache)
    cache.put("b", sized(40))
    assert list(keys) == ["a"]


def test_result_larger_than_the_cache_is_not_stored() -> None:
    cache = ResultCache(100)
    cache.put("a", sized(40))
    cache.put("b", sized(101))
    assert list(cache) == ["a"]
    cache.put("a", sized(101))
    assert list(cache) == []
    assert cache.nbytes == 0
