"""Capacity admits as many pages as the processors can serve."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from app.runtime.capacity import (
    ACTING_SECONDS,
    CONNECTION_SECONDS,
    FULL,
    IDLE_WEIGHT,
    LEAST_CORES,
    PAGES_PER_SECOND,
    Capacity,
    ProcessorTimes,
    page_weight,
)
from tests.app.clock import Clock

CORES_PER_PAGE = 0.02


@dataclass
class Machine:
    """Two simulated processors with other programs."""

    others: float = 0.0
    own: float = 0.0
    loop: float = 0.0

    def __post_init__(self) -> None:
        self.clock = Clock()
        self.times = ProcessorTimes(self.clock.now, 1000.0, 100.0, 50.0)

    def measure(self) -> ProcessorTimes:
        return self.times

    def capacity(self, processes: int = 1, cores_per_page: float = CORES_PER_PAGE) -> Capacity:
        return Capacity(cores_per_page, processes, self.measure, self.clock.monotonic, usable_cores=2)

    def run(self, capacity: Capacity, seconds: int, siblings: float = 0.0) -> None:
        for _ in range(seconds):
            self.clock.now += 1.0
            now, programs, own, loop = self.times
            self.times = ProcessorTimes(now + 1.0, programs + self.others + self.own + siblings, own + self.own, loop + self.loop)
            capacity.update()


def admitted(capacity: Capacity) -> int:
    """Return the number of visitors admitted before anyone has acted."""
    pages = dict[str, float]()
    while capacity.has_room(pages, str(len(pages))):
        pages[str(len(pages))] = 1.0
    return len(pages)


def test_pages_are_admitted_before_anyone_acts_up_to_a_share_of_a_processor() -> None:
    assert admitted(Machine().capacity()) == int(FULL / CORES_PER_PAGE)


def test_a_machine_that_makes_pages_half_as_fast_admits_half_as_many_visitors() -> None:
    fast, slow = (Machine().capacity(cores_per_page=0.0) for _ in range(2))
    for capacity, seconds in ((fast, 0.2), (slow, 0.4)):
        # The first page of a process takes longer.
        for page_seconds in (5.0, *[seconds] * 10):
            capacity.record_page(page_seconds)
    assert admitted(fast) == int(FULL / (0.2 * PAGES_PER_SECOND))
    assert admitted(slow) == int(FULL / (0.4 * PAGES_PER_SECOND))


def test_some_pages_are_admitted_before_any_page_is_made_and_after_a_slow_first_page() -> None:
    capacity = Machine().capacity(cores_per_page=0.0)
    assert 20 < admitted(capacity) < 40
    capacity.record_page(2.0)
    assert 1 < admitted(capacity) < 10


def test_a_given_use_of_the_processors_is_not_estimated() -> None:
    capacity = Machine().capacity()
    capacity.record_page(1.0)
    assert admitted(capacity) == int(FULL / CORES_PER_PAGE)


def test_each_of_two_processes_beside_a_busy_program_admits_half_as_many_pages() -> None:
    machine = Machine(others=1.0)
    capacity = machine.capacity(processes=2)
    machine.run(capacity, 20)
    assert admitted(capacity) == int(0.5 * FULL / CORES_PER_PAGE)


def test_a_busy_program_that_gets_less_because_of_the_pages_leaves_no_room_for_more() -> None:
    machine = Machine(others=1.0, own=0.3)
    capacity = machine.capacity(processes=2)
    machine.run(capacity, 20, siblings=0.3)
    machine.others, machine.own = 0.4, 0.8
    machine.run(capacity, 40, siblings=0.8)
    assert capacity.cores == pytest.approx(0.5)
    machine.own = 0.3
    machine.run(capacity, 20, siblings=0.3)
    assert capacity.cores == pytest.approx(0.8)


def test_the_use_of_this_process_and_its_siblings_does_not_count_as_use_of_other_programs() -> None:
    machine = Machine(own=0.7)
    capacity = machine.capacity(processes=2)
    machine.run(capacity, 20, siblings=0.7)
    assert capacity.cores == pytest.approx(1.0)


def test_some_pages_are_admitted_while_other_programs_keep_all_processors_busy() -> None:
    machine = Machine(others=2.0)
    capacity = machine.capacity()
    machine.run(capacity, 20)
    assert capacity.cores == LEAST_CORES
    assert 1 < admitted(capacity) < 10


def test_a_short_burst_of_another_program_counts_little() -> None:
    machine = Machine()
    capacity = machine.capacity()
    machine.run(capacity, 20)
    machine.others = 2.0
    machine.run(capacity, 5)
    assert capacity.cores == 1.0


def test_nobody_is_admitted_while_the_event_loop_is_busy_whatever_the_number_of_pages() -> None:
    machine = Machine(own=0.9, loop=0.9)
    capacity = machine.capacity()
    machine.run(capacity, 20)
    assert not capacity.has_room({"a": 1.0}, "b")
    assert capacity.is_crowded({"a": 1.0})


def test_work_is_postponed_before_pages_are_refused() -> None:
    capacity = Machine().capacity()
    crowd = {str(number): 1.0 for number in range(30)}
    assert capacity.is_crowded(crowd)
    assert capacity.has_room(crowd)
    assert not capacity.is_crowded({"a": 1.0})


def test_one_visitor_cannot_fill_the_server_for_others_but_may_use_all_of_it_alone() -> None:
    capacity = Machine().capacity()
    assert capacity.has_room({"crowd": 50.0}, "other")
    most = int(FULL / CORES_PER_PAGE)
    assert capacity.has_room({"crowd": most - 1.0}, "crowd")
    assert not capacity.has_room({"crowd": float(most)}, "crowd")


def test_an_idle_page_counts_less_and_an_abandoned_page_nothing() -> None:
    assert page_weight(0.0, connected=False) == page_weight(0.0, connected=True) == 1.0
    assert page_weight(CONNECTION_SECONDS, connected=False) == 0.0
    assert page_weight(CONNECTION_SECONDS, connected=True) == 1.0
    assert page_weight(CONNECTION_SECONDS + ACTING_SECONDS, connected=True) == IDLE_WEIGHT
