"""Outcomes have an order, words, and a form in files."""

from __future__ import annotations

from engine.systems.outcomes import Centre, End, EscapeCircle, Exit, outcomes_of, read_outcomes, write_outcomes

ALL = outcomes_of(2, (Centre(0.0, 0.0, 0.1, "the Moon"), Centre(1.0, 0.0, 0.1), EscapeCircle(10.0)))


def test_exits_come_first_then_centres_then_the_escape_radius() -> None:
    assert [outcome.label for outcome in ALL] == [
        "exit 1",
        "exit 2",
        "collision with the Moon",
        "collision with centre 2",
        "escape",
    ]
    assert [outcome.kind for outcome in ALL] == [Exit, Exit, Centre, Centre, EscapeCircle]


def test_each_outcome_has_a_sentence_and_a_verb() -> None:
    channel, _, moon, _, escape = ALL
    assert [each.sentence for each in (channel, moon, escape)] == [
        "Escaped through exit 1.", "Collided with the Moon.", "Escaped beyond the escape radius.",
    ]  # fmt: skip
    assert [each.present for each in (channel, moon)] == ["escapes through exit 1", "collides with the Moon"]
    assert [each.event for each in (channel, moon, escape)] == ["escape", "collision", "escape"]
    assert [each.origin for each in (channel, moon)] == [
        "entered through exit 1",
        "backward in time it collides with the Moon",
    ]


def test_a_verb_may_be_irregular() -> None:
    class Halo(End):
        key, word = "departure", "halo"
        label, action, verbs = "departure from {}", "leave {}", ("leaves", "left")

    outcome = Halo.outcome(1, "the halo")
    assert (outcome.present, outcome.sentence) == ("leaves the halo", "Left the halo.")


def test_written_outcomes_are_read_again() -> None:
    assert read_outcomes(write_outcomes(ALL)) == ALL
