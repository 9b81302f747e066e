"""The app, served on loopback as described in the README."""

from __future__ import annotations

import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
START_SECONDS = 600
"""Enough to compile all kernels on a busy machine."""


@dataclass(frozen=True)
class RunningApp:
    """A server process and its address; `root` ends without a slash."""

    root: str
    process: subprocess.Popen[bytes]

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"{self.root}/app"

    def figure(self, name: str) -> float:
        """One of the figures that the server counts."""
        with urllib.request.urlopen(f"{self.root}/metrics", timeout=60) as answer:
            lines = answer.read().decode().splitlines()
        return float(dict(line.rsplit(" ", 1) for line in lines if not line.startswith("#"))[f"escape_explorer_{name}"])


@contextmanager
def served_app(log: Path) -> Iterator[str]:
    """The address of the app; its output goes to `log`."""
    with running_app(log) as running:
        yield running.address


@contextmanager
def running_app(log: Path, *options: str) -> Iterator[RunningApp]:
    """The app, served with more options of `panel serve`; its kernels are there when this begins."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "panel", "serve", "app", "--address", "127.0.0.1", "--port", str(port)]
    command += ["--allow-websocket-origin", f"127.0.0.1:{port}", *options]
    with log.open("w") as output:
        process = subprocess.Popen(command, cwd=ROOT, stdout=output, stderr=subprocess.STDOUT)
    running = RunningApp(f"http://127.0.0.1:{port}", process)
    try:
        _wait_until_ready(running)
        yield running
    finally:
        process.terminate()
        process.wait(30)


def _wait_until_ready(running: RunningApp) -> None:
    end = time.monotonic() + START_SECONDS
    while time.monotonic() < end:
        if running.process.poll() is not None:
            raise RuntimeError(f"the server ended with {running.process.returncode}")
        try:
            with urllib.request.urlopen(f"{running.root}/readiness", timeout=60):
                return
        except urllib.error.HTTPError as not_yet:
            with not_yet:
                if "could not be compiled" in not_yet.read().decode():
                    raise RuntimeError("the server could not compile its kernels") from None
        except OSError:
            pass
        time.sleep(0.3)
    raise TimeoutError(f"the server was not ready within {START_SECONDS} s")
