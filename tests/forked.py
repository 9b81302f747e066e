"""Start child processes in milliseconds, as forks of one process that has imported the engine and the command line."""

from __future__ import annotations

import functools
import multiprocessing
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.context import ForkServerContext
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

from tests.waiting import SECONDS


@dataclass(frozen=True)
class Finished:
    """Exit code of a process, or minus the signal that killed it, and what it wrote to stdout and stderr."""

    code: int | None
    out: str
    err: str


def start(function: Callable[..., Any], *arguments: Any) -> BaseProcess:
    """Call a function of a module in a child process with the environment of this process. Arguments must be picklable."""
    process = fork_context().Process(target=_call, args=(dict(os.environ), function, arguments))
    process.start()
    return process


def run(folder: Path, function: Callable[..., Any], *arguments: Any) -> Finished:
    """Call a function in a child process, and wait for its end. The output of the process goes to temporary files in `folder`."""
    out, err = folder / ".out", folder / ".err"
    process = start(_call_redirected, out, err, function, arguments)
    process.join(SECONDS)
    if process.exitcode is None:
        process.kill()
    finished = Finished(process.exitcode, out.read_text(), err.read_text())
    out.unlink()
    err.unlink()
    return finished


@functools.cache
def fork_context() -> ForkServerContext:
    """Return the context of the children, for locks that they share."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["cli.main", "engine", "pytest"])
    return context


def _call(environment: dict[str, str], function: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
    os.environ.clear()
    os.environ.update(environment)
    function(*arguments)


def _call_redirected(out: Path, err: Path, function: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
    for path, stream in ((out, sys.stdout), (err, sys.stderr)):
        os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), stream.fileno())
    function(*arguments)
