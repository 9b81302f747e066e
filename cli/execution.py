"""Run computations of commands with threads or a cluster, with progress bars, until Ctrl-C cancels them."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, ThreadPoolExecutor
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, fields, replace
from types import FrameType
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from cli.option_marks import OptionChanges
from engine import Execution
from engine.foundations.extras import require_package

if TYPE_CHECKING:
    from distributed import Client


@dataclass(frozen=True)
class RunContext:
    """The execution and the progress bars of one run.

    Attributes
    ----------
    execution
        Execution that Ctrl-C cancels.
    progress
        Progress bars, disabled unless stderr is a terminal.
    """

    execution: Execution
    progress: Progress

    def start_stage(self, stage: str) -> Execution:
        """Show the bar of a new stage, unless bars are disabled, and return the execution that reports to the bar.

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


@dataclass(frozen=True)
class Place:
    """The place where a command computes.

    Attributes
    ----------
    threads
        Number of threads; by default one per core.
    scheduler
        Address of the Dask scheduler on whose cluster the command computes.
    local_cluster
        Number of workers of a Dask cluster that is started on this machine.
    """

    threads: Annotated[int | None, typer.Option(min=1, metavar="N")] = None
    scheduler: Annotated[str | None, typer.Option(metavar="ADDRESS")] = None
    local_cluster: Annotated[int | None, typer.Option(min=1, metavar="N")] = None

    @contextmanager
    def run(self) -> Iterator[RunContext]:
        """Run a long computation that Ctrl-C cancels.

        Raises
        ------
        concurrent.futures.CancelledError
            On exit, if Ctrl-C was pressed. Results may be incomplete and must not be written.
        """
        cancel = threading.Event()
        console = Console(stderr=True)
        columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
        bars = Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
        with self._executor() as executor, _cancel_on_ctrl_c(cancel), bars:
            context = RunContext(Execution(executor, cancel), bars)
            yield context
            context.execution.raise_if_cancelled()

    def _executor(self) -> AbstractContextManager[Executor | None]:
        """Return the executor; None for the default pool of threads."""
        given_places = [field.name for field in fields(self) if getattr(self, field.name)]
        if len(given_places) > 1:
            raise ValueError(f"{' and '.join(given_places)}: choose one place to compute")
        if self.scheduler is not None or self.local_cluster is not None:
            return _cluster_executor(self.scheduler, self.local_cluster)
        return nullcontext() if self.threads is None else ThreadPoolExecutor(self.threads)


THREADS_ONLY = OptionChanges(without=("scheduler", "local_cluster"))
"""Mark of a place for a command that computes only in this process."""


def _cancel_on_ctrl_c(cancel: threading.Event) -> AbstractContextManager[None]:
    """Set `cancel` at the first Ctrl-C, and raise KeyboardInterrupt at the second."""

    def stop(number: int, frame: FrameType | None) -> None:
        if cancel.is_set():
            signal.default_int_handler(number, frame)
        cancel.set()

    # A shell starts background jobs with SIGINT ignored, which must remain so.
    return nullcontext() if signal.getsignal(signal.SIGINT) is signal.SIG_IGN else _handle_ctrl_c(stop)


@contextmanager
def _handle_ctrl_c(handler: Callable[[int, FrameType | None], None] | signal.Handlers) -> Iterator[None]:
    """Replace the handler of Ctrl-C. Only the main thread can do so; in other threads the handler stays."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous_handler = signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous_handler)


@contextmanager
def _cluster_executor(scheduler: str | None, local_workers: int | None) -> Iterator[Executor]:
    """Yield the executor of a cluster.

    Parameters
    ----------
    scheduler
        Address of a running scheduler, ``tcp://host:port``.
    local_workers
        Number of worker processes to start on this machine if there is no scheduler, with one thread each.

    Raises
    ------
    ModuleNotFoundError
        If Dask is not installed.
    OSError
        If the scheduler does not answer; ConnectionError if the scheduler or the workers are lost during the computation.
    """
    with _connect(scheduler, local_workers) as client, describe_losses():
        yield client.get_executor()


def _connect(scheduler: str | None, local_workers: int | None) -> Client:
    require_package("distributed", "cluster")
    import distributed

    if scheduler is not None:
        return distributed.Client(scheduler)  # type: ignore[no-untyped-call]
    # A terminal sends Ctrl-C to the whole process group. The workers ignore it, and this process ends them.
    with _handle_ctrl_c(signal.SIG_IGN):
        # The dashboard takes a free port on the loopback interface.
        return distributed.Client(n_workers=local_workers, threads_per_worker=1, dashboard_address="127.0.0.1:0")  # type: ignore[no-untyped-call]


@contextmanager
def describe_losses() -> Iterator[None]:
    """Replace Dask's errors about a lost scheduler or lost workers by ConnectionErrors with a remedy."""
    from distributed import KilledWorker
    from distributed.comm.core import CommClosedError

    try:
        yield
    except KilledWorker as error:
        raise ConnectionError(
            "several workers died in turn of the same part of the computation; check their memory, then run the command again"
        ) from error
    except (BrokenExecutor, OSError) as error:
        # Errors of the operating system have a number. A plain OSError without a number means that the scheduler does not answer.
        if isinstance(error, BrokenExecutor | CommClosedError) or (type(error) is OSError and error.errno is None):
            raise ConnectionError("the scheduler of the cluster is lost; start it, then run the same command again") from error
        raise
