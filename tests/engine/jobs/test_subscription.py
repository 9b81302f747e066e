"""What somebody hears of a job, whatever threads tell them."""

from __future__ import annotations

import threading

from engine.jobs.subscription import Subscription


def nothing(_: object) -> None:
    """Nobody listens."""


def test_the_last_result_waits_for_a_frame_that_is_being_handed_over() -> None:
    handed_over: list[str] = []
    begun, go_on = threading.Event(), threading.Event()

    def take(what: str) -> None:
        if what == "frame":
            begun.set()
            assert go_on.wait(10)
        handed_over.append(what)

    ticket = Subscription(nothing, take, nothing)
    frame = threading.Thread(target=ticket.deliver, args=("frame",), kwargs={"last": False})
    whole = threading.Thread(target=ticket.deliver, args=("whole",), kwargs={"last": True})
    frame.start()
    assert begun.wait(10)
    whole.start()
    whole.join(0.1)
    go_on.set()
    frame.join(10)
    whole.join(10)
    assert handed_over == ["frame", "whole"]
    assert not ticket.open


def test_nothing_comes_after_the_last_result_or_a_cancel() -> None:
    handed_over: list[str] = []
    for end in ("whole", "cancel"):
        ticket = Subscription(nothing, handed_over.append, nothing)
        if end == "whole":
            ticket.deliver("whole", last=True)
        else:
            ticket.cancel()
        ticket.deliver("frame", last=False)
    assert handed_over == ["whole"]


def test_a_listener_may_cancel_what_it_is_told() -> None:
    ticket = Subscription(nothing, lambda frame: ticket.cancel(), nothing)
    ticket.deliver("frame", last=False)
    assert not ticket.open
