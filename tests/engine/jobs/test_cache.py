"""The cache keeps what was used last, below its limit."""

from __future__ import annotations

from engine.jobs.cache import ResultCache


class Weight:
    """A result of a given size."""

    def __init__(self, nbytes: int) -> None:
        self.nbytes = nbytes


def test_the_cache_stays_below_its_limit_and_drops_what_was_not_used() -> None:
    cache = ResultCache(100)
    for key in ("a", "b", "c"):
        cache.put(key, Weight(40))
        cache.get("a")
    assert cache.nbytes == 80
    assert set(cache) == {"a", "c"}


def test_a_result_larger_than_the_cache_is_not_kept() -> None:
    cache = ResultCache(100)
    cache.put("a", Weight(40))
    cache.put("b", Weight(101))
    assert list(cache) == ["a"]
