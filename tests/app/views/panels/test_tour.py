"""The tour shows its steps and ends."""

from __future__ import annotations

from app.views.panels.tour import STEPS, Act, Tour


def test_a_tour_runs_only_once_started() -> None:
    tour = Tour(lambda act: None)
    assert not tour.running
    tour.start()
    assert tour.running
    assert tour.step is STEPS[0]


def test_the_last_step_ends_the_tour() -> None:
    tour = Tour(lambda act: None)
    tour.start()
    seen = []
    while tour.running:
        seen.append(tour.step)
        tour.next()
    assert seen == list(STEPS)


def test_going_back_stays_within_the_tour() -> None:
    tour = Tour(lambda act: None)
    tour.start()
    tour.next()
    tour.back()
    tour.back()
    assert tour.step is STEPS[0]
    assert tour.running


def test_a_tour_always_starts_at_the_first_step() -> None:
    tour = Tour(lambda act: None)
    tour.start()
    tour.next()
    tour.stop()
    assert not tour.running
    tour.start()
    assert tour.step is STEPS[0]


def test_a_step_shows_what_it_offers() -> None:
    acts: list[Act] = []
    tour = Tour(acts.append)
    tour.start()
    for _ in STEPS:
        tour._receive("act")
        tour._receive("next")
    assert acts == [step.act for step in STEPS if step.act is not None] == list(Act)
    assert not tour.running


def test_a_tour_is_short_and_its_steps_are_brief() -> None:
    assert 5 <= len(STEPS) <= 7
    for step in STEPS:
        assert 1 <= step.text.count(". ") + 1 <= 3
        assert step.text.endswith(".")
