"""A subscription delivers results in order, and none after the final result or its cancellation."""

from __future__ import annotations

import threading

from engine.jobs.subscription import Subscription
from tests.waiting import SECONDS


def ignore(_: object) -> None:
    """Do nothing, as a callback."""


def test_final_result_waits_for_a_partial_one_in_delivery() -> None:
    delivered: list[str] = []
    entered, proceed = threading.Event(), threading.Event()

    def receive(result: str) -> None:
        if result == "partial":
            entered.set()
            assert proceed.wait(SECONDS)
        delivered.append(result)

    subscription = Subscription(ignore, receive, ignore)
    partial = threading.Thread(target=subscription.deliver, args=("partial",), kwargs={"last": False})
    final = threading.Thread(target=subscription.deliver, args=("final",), kwargs={"last": True})
    partial.start()
    assert entered.wait(SECONDS)
    final.start()
    final.join(0.1)
    proceed.set()
    partial.join(SECONDS)
    final.join(SECONDS)
    assert delivered == ["partial", "final"]
    assert not subscription.open


def test_nothing_is_delivered_after_the_final_result_or_cancel() -> None:
    delivered: list[str] = []
    for end in ("final", "cancel"):
        subscription = Subscription(ignore, delivered.append, ignore)
        if end == "final":
            subscription.deliver("final", last=True)
        else:
            subscription.cancel()
        subscription.deliver("partial", last=False)
    assert delivered == ["final"]


def test_callback_may_cancel_its_subscription() -> None:
    subscription = Subscription(ignore, lambda _: subscription.cancel(), ignore)
    subscription.deliver("partial", last=False)
    assert not subscription.open
