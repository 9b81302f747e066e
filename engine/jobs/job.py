"""A job: a computation as data, which is also the key of its result."""

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
    """The queue in which the calls of a job wait for a thread."""

    FIRST_FRAME = "first frame"
    """The function makes many short calls, which come before all others up to its first result."""

    BACKGROUND = "background"
    """The function makes many short calls."""

    LONG_CALL = "long call"
    """The function is one call of up to seconds."""

    LIMITED = "limited"
    """The function is one call on what a visitor typed, in a process with limits if there is one; an account has one at once."""

    COMPILATION = "compilation"
    """The function compiles kernels; one at a time runs in the process."""


@dataclass(frozen=True)
class Job[Result]:
    """A function and its arguments, hashable; equal jobs are computed once.

    The manager adds those of these options that the function has parameters for: ``execution``, ``on_frame`` for partial
    results, ``resume``, and ``find_result``, which returns the result of another job.

    Attributes
    ----------
    function
        Computes the result; raises CancelledError, or returns a result whose ``complete`` is False, when it is cancelled.
    arguments
        Its positional arguments. A job is replaced by its result, which must be complete.
    options
        ((name, value), …): keyword arguments.
    queue
        How its calls wait for a thread.
    orbits
        Number of orbits that the function holds in memory.
    find_earlier
        Called with the job and the cache: the cached result that the function continues as ``resume``, or None.
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
        """The keyword arguments of a call: the options, and the offered values for which the function has parameters."""
        names = _parameters(self.function)
        return {**{name: value for name, value in offered.items() if name in names}, **dict(self.options)}


def run_job[Result](job: Job[Result], execution: Execution, known: Mapping[Job[Any], Any]) -> Result:
    """Compute a job in this thread.

    Parameters
    ----------
    job
        The job.
    execution
        How it and the jobs among its arguments run.
    known
        Results of some of these.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    """
    if job in known:
        found: Result = known[job]
        return found
    arguments = [run_job(each, execution, known) if isinstance(each, Job) else each for each in job.arguments]
    result = job.function(*arguments, **job.keywords({"execution": execution}))
    execution.raise_if_cancelled()
    return result


@functools.cache
def _parameters(function: Callable[..., Any]) -> frozenset[str]:
    return frozenset(inspect.signature(function).parameters)
