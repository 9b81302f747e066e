"""Each action of the user is one entry of the browser's history."""

from __future__ import annotations

from app.session.context import History


def test_each_action_is_an_entry_and_all_changes_of_a_gesture_are_one() -> None:
    history, entries = History(), []
    assert [history.entry, history.record(), history.record()] == [0, 1, 2]
    for _ in range(3):
        history.begin_gesture()
        entries.append(history.record())
    history.end_gesture()
    assert [*entries, history.record()] == [3, 3, 3, 4]
    # Going back ends a gesture.
    history.begin_gesture()
    history.record()
    history.move_to(0)
    history.begin_gesture()
    assert [history.record(), history.record()] == [1, 1]


def test_back_and_forward_lead_through_the_entries_until_another_action_drops_them() -> None:
    history = History()
    for _ in range(3):
        history.record()
    for entry in (1, 0, 3, 1):
        history.move_to(entry)
        assert history.entry == entry
    assert history.record() == 2
    # Unknown entries count as the first.
    for unknown in (3, -1, 7):
        history.move_to(unknown)
        assert history.entry == 0
