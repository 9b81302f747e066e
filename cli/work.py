"""Work under way: Ctrl-C stops it in good order, a bar on the terminal tells how far it is."""

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
class Work:
    """What computations need.

    Attributes
    ----------
    cancel
        Set by Ctrl-C.
    executor
        The pool; None for the engine's own, with a thread for each core.
    progress
        The bars; nobody sees them unless stderr is a terminal.
    """

    cancel: threading.Event
    executor: Executor | None
    progress: Progress

    def begin(self, stage: str) -> Callable[[float], None] | None:
        """Show what is done next; the returned call tells its share, 0 to 1. None where nobody looks: it costs time.

        Raises CancelledError when stopped already.
        """
        self.stop_if_cancelled()
        if self.progress.disable:
            return None
        for task in self.progress.tasks:
            self.progress.update(task.id, total=1.0, completed=1.0)
        task_id = self.progress.add_task(stage, total=None)
        return lambda share: self.progress.update(task_id, total=1.0, completed=share)

    def stop_if_cancelled(self) -> None:
        """Raise CancelledError when stopped."""
        if self.cancel.is_set():
            raise CancelledError


@contextmanager
def working(threads: int | None = None, executor: Executor | None = None) -> Iterator[Work]:
    """Everything inside may take long; on leaving it is whole.

    Parameters
    ----------
    threads
        Of a pool of its own, 1 or more; None for none.
    executor
        Where to compute instead, such as a cluster's; left open.

    Raises
    ------
    concurrent.futures.CancelledError
        On leaving, when Ctrl-C was pressed: what was computed may be unfinished, and is not to be written.
    """
    cancel = threading.Event()
    console = Console(stderr=True)
    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    bars = Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
    pool = nullcontext(executor) if executor is not None or threads is None else ThreadPoolExecutor(threads)
    with pool as chosen, _ctrl_c_sets(cancel), bars:
        work = Work(cancel, chosen, bars)
        yield work
        work.stop_if_cancelled()


@contextmanager
def _ctrl_c_sets(cancel: threading.Event) -> Iterator[None]:
    """The first Ctrl-C asks the work to stop, which it does within 0.2 s; a second one does not wait for it."""
    elsewhere = threading.current_thread() is not threading.main_thread()
    if elsewhere or signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        # Signals come to the main thread; and who starts a program in the background has them ignored.
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
