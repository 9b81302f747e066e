"""Cancellation by Ctrl-C and progress bars for one run of a command."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from types import FrameType

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn


@dataclass(frozen=True)
class RunContext:
    """Executor, cancel event and progress bars of one run.

    Attributes
    ----------
    cancel
        Set by Ctrl-C.
    executor
        Executor of the computations; None for the default pool with one thread per core.
    progress
        Progress bars, disabled unless stderr is a terminal.
    """

    cancel: threading.Event
    executor: Executor | None
    progress: Progress

    def start_stage(self, stage: str) -> Callable[[float], None] | None:
        """Show a new stage and return its progress callback, which takes a share from 0 to 1; None if bars are disabled.

        Raises
        ------
        concurrent.futures.CancelledError
            If the run is already cancelled.
        """
        self.raise_if_cancelled()
        if self.progress.disable:
            return None
        for task in self.progress.tasks:
            self.progress.update(task.id, total=1.0, completed=1.0)
        task_id = self.progress.add_task(stage, total=None)
        return lambda share: self.progress.update(task_id, total=1.0, completed=share)

    def raise_if_cancelled(self) -> None:
        """Raise `concurrent.futures.CancelledError` if Ctrl-C was pressed."""
        if self.cancel.is_set():
            raise CancelledError


@contextmanager
def cancellable_run(threads: int | None = None, executor: Executor | None = None) -> Iterator[RunContext]:
    """Run a long computation that Ctrl-C cancels.

    Parameters
    ----------
    threads
        Size of a new thread pool, 1 or more; None for the default pool.
    executor
        Executor to use instead, such as a cluster's; not shut down here.

    Raises
    ------
    concurrent.futures.CancelledError
        On exit, if Ctrl-C was pressed: results may be incomplete and must not be written.
    """
    cancel = threading.Event()
    console = Console(stderr=True)
    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    bars = Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
    pool = nullcontext(executor) if executor is not None or threads is None else ThreadPoolExecutor(threads)
    with pool as chosen, _cancel_on_ctrl_c(cancel), bars:
        context = RunContext(cancel, chosen, bars)
        yield context
        context.raise_if_cancelled()


@contextmanager
def _cancel_on_ctrl_c(cancel: threading.Event) -> Iterator[None]:
    """Set `cancel` at the first Ctrl-C; a second one raises KeyboardInterrupt at once."""
    in_thread = threading.current_thread() is not threading.main_thread()
    if in_thread or signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        # Signal handlers belong to the main thread, and a shell starts background jobs with SIGINT ignored.
        yield
        return

    def stop(number: int, frame: FrameType | None) -> None:
        if cancel.is_set():
            signal.default_int_handler(number, frame)
        cancel.set()

    before = signal.signal(signal.SIGINT, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
