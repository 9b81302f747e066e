"""Serve the app on loopback, as described in the README."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
import urllib.request
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from tests.waiting import SECONDS

ROOT = Path(__file__).parents[2]
START_SECONDS = 600
"""Longest time until the app is ready: enough to compile all kernels on a busy machine."""
PANEL = ("panel", "serve", "app")
READY = ": ready\n"
"""Text that the server writes when its kernels are compiled."""
NO_VARIABLES: Mapping[str, str] = {}


class Output:
    """Copies what a process writes to a file, and waits for texts in it."""

    def __init__(self, stream: IO[str], log: Path) -> None:
        self._stream, self._log = stream, log
        self._changed, self._text, self._has_ended = threading.Condition(), "", False
        self._copier = threading.Thread(target=self._copy)
        self._copier.start()

    def wait_for(self, text: str) -> None:
        """Wait until the process has written a text. RuntimeError if the process ends or fails before."""
        with self._changed:
            self._changed.wait_for(lambda: text in self._text or self._has_failed(), START_SECONDS)
            if text not in self._text:
                raise RuntimeError(f"the server did not write {text!r}: {self._text}")

    def close(self) -> None:
        """Wait until everything is copied. Call this after the end of the process."""
        self._copier.join()
        self._stream.close()

    def _has_failed(self) -> bool:
        return self._has_ended or "could not be prepared" in self._text

    def _copy(self) -> None:
        with self._log.open("w") as file:
            for line in self._stream:
                file.write(line)
                file.flush()
                with self._changed:
                    self._text += line
                    self._changed.notify_all()
        with self._changed:
            self._has_ended = True
            self._changed.notify_all()


def free_port() -> int:
    """Return a port of the loopback interface on which nothing listens."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


@dataclass(frozen=True)
class RunningApp:
    """A server process, its origin and its output. `root` is the origin, without a slash at the end."""

    root: str
    process: subprocess.Popen[str]
    output: Output

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"{self.root}/app"

    def figure(self, name: str) -> float:
        """Return the number of a metric of the server."""
        with urllib.request.urlopen(f"{self.root}/metrics", timeout=SECONDS) as answer:
            lines = answer.read().decode().splitlines()
        return float(dict(line.rsplit(" ", 1) for line in lines if not line.startswith("#"))[f"escape_explorer_{name}"])


@contextmanager
def served_app(log: Path) -> Iterator[str]:
    """Yield the address of the app; its output goes to `log`."""
    with running_app(log) as running:
        yield running.address


@contextmanager
def running_app(log: Path, *options: str) -> Iterator[RunningApp]:
    """Run the app with additional options of `panel serve`. Yield when its kernels are compiled."""
    with started_app(log, *PANEL, *options) as running:
        running.output.wait_for(READY)
        yield running


@contextmanager
def started_app(
    log: Path, *command: str, port: int | None = None, variables: Mapping[str, str] = NO_VARIABLES
) -> Iterator[RunningApp]:
    """Run a module that serves the app, with options, a port and environment variables. Yield when the server listens."""
    port = free_port() if port is None else port
    options = ["--address", "127.0.0.1", "--port", str(port), "--allow-websocket-origin", f"127.0.0.1:{port}"]
    process = subprocess.Popen(
        [sys.executable, "-m", *command, *options],
        cwd=ROOT,
        env={**os.environ, **variables},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert process.stdout is not None
    output = Output(process.stdout, log)
    try:
        # The server already listens when it writes this.
        output.wait_for("preparing ")
        yield RunningApp(f"http://127.0.0.1:{port}", process, output)
    finally:
        process.terminate()
        process.wait(SECONDS)
        output.close()
