"""Cancellation by Ctrl-C and progress bars for one run of a command."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, replace
from types import FrameType

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from engine import Execution


@dataclass(frozen=True)
class RunContext:
    """How the computations of one run are executed, with its progress bars.

    Attributes
    ----------
    execution
        Cancelled by Ctrl-C.
    progress
        Progress bars, disabled unless stderr is a terminal.
    """

    execution: Execution
    progress: Progress

    def start_stage(self, stage: str) -> Execution:
        """Show the bar of a new stage, unless bars are disabled, and return the execution that reports to it.

        Raises
        ------
        concurrent.futures.CancelledError
            If the run is already cancelled.
        """
        self.execution.raise_if_cancelled()
        if self.progress.disable:
            return self.execution
        for task in self.progress.tasks:
            self.progress.update(task.id, total=1.0, completed=1.0)
        task_id = self.progress.add_task(stage, total=None)
        return replace(self.execution, on_progress=lambda share: self.progress.update(task_id, total=1.0, completed=share))


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
        context = RunContext(Execution(chosen, cancel), bars)
        yield context
        context.execution.raise_if_cancelled()


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
