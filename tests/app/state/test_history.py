"""Each action of the user is one entry of the browser's history."""

from __future__ import annotations

from app.state.history import History


def test_each_action_is_an_entry() -> None:
    history = History()
    assert history.entry == 0
    assert [history.record(), history.record()] == [1, 2]
    assert history.entry == 2


def test_all_changes_of_a_gesture_are_one_entry() -> None:
    history = History()
    history.record()
    entries = []
    for _ in range(3):
        history.begin_gesture()
        entries.append(history.record())
    history.end_gesture()
    assert entries == [2, 2, 2]
    assert history.record() == 3


def test_back_and_forward_lead_through_the_entries() -> None:
    history = History()
    history.record()
    history.record()
    for entry in (1, 0, 2):
        history.move_to(entry)
        assert history.entry == entry


def test_an_action_after_going_back_drops_later_entries() -> None:
    history = History()
    for _ in range(3):
        history.record()
    history.move_to(1)
    assert history.record() == 2
    history.move_to(3)
    assert history.entry == 0


def test_unknown_entries_count_as_the_first() -> None:
    history = History()
    history.record()
    for unknown in (-1, 7):
        history.move_to(unknown)
        assert history.entry == 0


def test_going_back_ends_a_gesture() -> None:
    history = History()
    history.begin_gesture()
    history.record()
    history.move_to(0)
    history.begin_gesture()
    assert [history.record(), history.record()] == [1, 1]
