"""A client of the job manager. Threads are shared fairly among clients, and the open requests of each client are limited."""

from __future__ import annotations

from collections.abc import Callable, Hashable

from engine.foundations.validation import checked_count
from engine.jobs.job import Job
from engine.jobs.manager import Jobs
from engine.jobs.subscription import Subscription

MOST_REQUESTS = 32
"""Default limit on the open requests of one client. All controls of a page together cause fewer requests."""

# Largest legal limit on the open requests of one client.
_LARGEST_LIMIT = 1000


class JobClient:
    """One client of `Jobs`, such as a browser session.

    Parameters
    ----------
    jobs
        The job manager.
    most_requests
        Largest number of requests open at the same time, 1 to 1000.
    account
        The account of the client, see `Jobs.request`.
    """

    def __init__(self, jobs: Jobs, most_requests: int = MOST_REQUESTS, account: Hashable = None) -> None:
        self._jobs, self._account = jobs, account
        self._most_requests = checked_count("most_requests", most_requests, 1, _LARGEST_LIMIT)
        self._subscriptions: list[Subscription] = []

    def request[Result](
        self, job: Job[Result], on_result: Callable[[Result], None], on_error: Callable[[Exception], None]
    ) -> Subscription:
        """Request a result as `Jobs.request` does; `on_error` receives a ValueError if too many requests are open."""
        refused_subscription = self._refuse_above_limit(on_error)
        if refused_subscription is not None:
            return refused_subscription
        subscription = self._jobs.request(job, on_result, on_error, client=self, account=self._account)
        self._subscriptions.append(subscription)
        return subscription

    def close(self) -> None:
        """Cancel all subscriptions."""
        for subscription in self._subscriptions:
            subscription.cancel()
        self._subscriptions.clear()

    def _refuse_above_limit(self, on_error: Callable[[Exception], None]) -> Subscription | None:
        """Return None if another request is allowed, otherwise a closed subscription whose error has been reported."""
        self._subscriptions = [subscription for subscription in self._subscriptions if subscription.open]
        if len(self._subscriptions) < self._most_requests:
            return None
        refused_subscription = Subscription(lambda _: None, lambda _: None, on_error)
        refused_subscription.fail(
            ValueError(
                f"requests: {self._most_requests} are under way for this page, which is the limit; "
                "wait for one to finish, or switch something off"
            )
        )
        return refused_subscription


JobSubmitter = Jobs | JobClient
"""An object that accepts requests: the job manager itself, or one of its clients."""
