"""One pool for many: first looks first, then turns, and never all threads on calls that last."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait

import pytest

from engine.execution import count_workers
from engine.jobs.scheduler import FairScheduler, Line, Priority

SECONDS = 10.0


class Stage:
    """A pool of so many threads, all held up until the curtain rises; then it notes in which order calls are made."""

    def __init__(self, threads: int = 1) -> None:
        self.pool = FairScheduler(ThreadPoolExecutor(threads))
        self.curtain = threading.Event()
        self.order: list[str] = []
        opening = self.pool.line("nobody", lambda: Priority.TILE)
        self.held = [opening.submit(self.curtain.wait, SECONDS) for _ in range(threads)]

    def line(self, owner: str, rank: Callable[[], Priority] = lambda: Priority.TILE) -> Line:
        return self.pool.line(owner, rank)

    def ask(self, line: Line, *names: str) -> list[Future[None]]:
        return [line.submit(self.order.append, name) for name in names]

    def play(self, *futures: Future[None]) -> list[str]:
        self.curtain.set()
        assert not wait(futures, SECONDS).not_done
        return self.order


def test_owners_take_turns_whoever_came_first() -> None:
    stage = Stage()
    first = stage.ask(stage.line("a"), "a1", "a2", "a3")
    second = stage.ask(stage.line("b"), "b1", "b2")
    assert stage.play(*first, *second) == ["a1", "b1", "a2", "b2", "a3"]


def test_two_jobs_of_one_owner_share_a_turn() -> None:
    stage = Stage()
    jobs = [*stage.ask(stage.line("a"), "a1"), *stage.ask(stage.line("a"), "a2"), *stage.ask(stage.line("b"), "b1")]
    assert stage.play(*jobs) == ["a1", "b1", "a2"]


def test_first_looks_come_before_everything_else() -> None:
    stage = Stage()
    others = stage.ask(stage.line("a"), "a1", "a2")
    looks = stage.ask(stage.line("b", lambda: Priority.FIRST_LOOK), "b1", "b2")
    assert stage.play(*others, *looks) == ["b1", "b2", "a1", "a2"]


def test_a_job_falls_back_as_soon_as_it_has_shown_something() -> None:
    stage, shown = Stage(), threading.Event()
    line = stage.line("b", lambda: Priority.TILE if shown.is_set() else Priority.FIRST_LOOK)
    calls = [line.submit(lambda: (stage.order.append("b1"), shown.set())), *stage.ask(line, "b2")]
    calls += stage.ask(stage.line("a", lambda: Priority.FIRST_LOOK), "a1", "a2")
    stage.play(*calls)
    assert stage.order == ["b1", "a1", "a2", "b2"]


def test_calls_that_last_leave_one_thread_to_the_others() -> None:
    stage, release = Stage(threads=2), threading.Event()
    lasting = [stage.line(name, lambda: Priority.WHOLE).submit(release.wait, SECONDS) for name in "abc"]
    quick = stage.ask(stage.line("d"), "d1")
    assert stage.play(*quick) == ["d1"]
    assert not any(call.done() for call in lasting)
    release.set()
    assert not wait(lasting, SECONDS).not_done


def test_a_single_thread_does_calls_that_last_too() -> None:
    stage = Stage()
    lasting = stage.ask(stage.line("a", lambda: Priority.WHOLE), "a1", "a2")
    assert stage.play(*lasting) == ["a1", "a2"]


def test_an_error_reaches_the_one_who_asked_and_the_pool_goes_on() -> None:
    stage = Stage()

    def fail() -> None:
        raise RuntimeError("broken")

    broken, following = stage.line("a").submit(fail), stage.ask(stage.line("a"), "a1")
    assert stage.play(*following) == ["a1"]
    with pytest.raises(RuntimeError, match="broken"):
        broken.result(SECONDS)


def test_a_call_given_up_is_not_made() -> None:
    stage = Stage()
    (given_up,), following = stage.ask(stage.line("a"), "a1"), stage.ask(stage.line("a"), "a2")
    assert given_up.cancel()
    assert stage.play(*following) == ["a2"]


def test_a_line_has_as_many_workers_as_the_pool() -> None:
    assert count_workers(Stage(threads=3).line("a")) == 3


def test_what_waits_is_counted() -> None:
    stage = Stage()
    stage.pool.line("a", lambda: Priority.TILE)
    calls = stage.ask(stage.line("a"), "a1", "a2")
    assert stage.pool.waiting >= 2
    stage.play(*calls)
    assert stage.pool.waiting == 0


def test_while_it_is_told_so_it_puts_off_tiles() -> None:
    stage = Stage(threads=2)
    stage.pool.put_off_tiles(True)
    tiles = stage.ask(stage.line("a"), "a1", "a2")
    others = [
        *stage.ask(stage.line("b", lambda: Priority.FIRST_LOOK), "b1"),
        *stage.ask(stage.line("c", lambda: Priority.WHOLE), "c1"),
    ]
    stage.curtain.set()
    assert not wait(others, SECONDS).not_done
    assert sorted(stage.order) == ["b1", "c1"]
    assert not wait(tiles, 0.2).done
    stage.pool.put_off_tiles(False)
    assert not wait(tiles, SECONDS).not_done


def test_what_was_clicked_comes_before_what_makes_pictures_finer() -> None:
    stage = Stage()
    tiles = stage.ask(stage.line("a"), "a1", "a2")
    orbits = stage.ask(stage.line("b", lambda: Priority.WHOLE), "b1")
    assert stage.play(*tiles, *orbits) == ["b1", "a1", "a2"]


def test_calls_that_nobody_has_taken_up_can_be_dropped() -> None:
    stage = Stage()
    line = stage.line("a")
    dropped, others = stage.ask(line, "a1", "a2"), stage.ask(stage.line("a"), "a3")
    line.drop()
    assert not wait(dropped, SECONDS).not_done
    assert all(future.cancelled() for future in dropped)
    assert stage.play(*others) == ["a3"]
