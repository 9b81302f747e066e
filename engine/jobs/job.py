"""A job: a computation as data. The job is also the key of its result."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from engine.foundations.execution import Execution
from engine.jobs.cache import ResultCache


class Queue(Enum):
    """The queue in which the calls of a job wait for a thread. It depends on the kind of the calls."""

    FIRST_FRAME = "first frame"
    """The function submits many short calls. Until its first result, these calls precede all other calls."""

    BACKGROUND = "background"
    """The function submits many short calls."""

    SPARE = "spare"
    """The function submits many short calls, which run only while no other calls wait."""

    LONG_CALL = "long call"
    """The function itself is one call, which takes up to some seconds."""

    LIMITED = "limited"
    """The function itself is one call that evaluates a visitor's text, with limited resources if `Jobs` has `run_limited`.

    Only one such call of an account runs at a time.
    """

    COMPILATION = "compilation"
    """The function itself is one call that compiles kernels. Only one such call runs at a time in the process."""


@dataclass(frozen=True)
class Job[Result]:
    """A function and its arguments, hashable. Equal jobs are computed once.

    The manager also passes ``execution``, ``on_frame`` to call with partial results, ``resume``, and ``find_result``, which
    returns the result of another job, as far as the function has parameters with these names.

    Attributes
    ----------
    function
        The function, which returns the result. If its execution is cancelled, it raises CancelledError or returns a result whose
        ``complete`` is False.
    arguments
        Positional arguments of the function. A job among them is replaced by its result, which must be complete.
    options
        ((name, value), …): keyword arguments.
    queue
        The queue in which calls wait for a thread.
    orbits
        Number of orbits that the function holds in memory.
    find_earlier
        Returns a cached result to continue, given the job and the cache, or None. This result is passed as ``resume``.
    """

    function: Callable[..., Result]
    arguments: tuple[Any, ...]
    options: tuple[tuple[str, Any], ...] = ()
    queue: Queue = Queue.BACKGROUND
    orbits: int = field(default=0, compare=False)
    find_earlier: Callable[[Job[Any], ResultCache], Result | None] | None = field(default=None, compare=False)

    @property
    def orbits_held(self) -> int:
        """Number of orbits held by the function and by the jobs among its arguments."""
        return self.orbits + sum(argument.orbits_held for argument in self.arguments if isinstance(argument, Job))

    def keywords(self, offered: Mapping[str, Any]) -> dict[str, Any]:
        """Return the keyword arguments of a call: the options, and the offered values for which the function has parameters."""
        names = _parameter_names(self.function)
        return {**{name: value for name, value in offered.items() if name in names}, **dict(self.options)}


def run_job[Result](job: Job[Result], execution: Execution, known_results: Mapping[Job[Any], Any]) -> Result:
    """Compute a job in this thread.

    Parameters
    ----------
    job
        The job.
    execution
        Execution of the job, of the jobs among its arguments, and of those whose results it asks for.
    known_results
        Results that are not computed again, by job.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    """
    if job in known_results:
        return known_results[job]
    arguments = [run_job(value, execution, known_results) if isinstance(value, Job) else value for value in job.arguments]
    find_result = functools.partial(run_job, execution=execution, known_results=known_results)
    result = job.function(*arguments, **job.keywords({"execution": execution, "find_result": find_result}))
    execution.raise_if_cancelled()
    return result


@functools.cache
def _parameter_names(function: Callable[..., Any]) -> frozenset[str]:
    """Return the names of the parameters of a function."""
    return frozenset(inspect.signature(function).parameters)
