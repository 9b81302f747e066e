"""Fixtures of the tests of the command line."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr
from io import StringIO

import pytest

from cli.main import main

Run = Callable[..., tuple[int, str, str]]
"""Runs a command, and returns its exit code, stdout and stderr."""


@pytest.fixture(autouse=True)
def default_sigint() -> Iterator[None]:
    """Restore Python's handler of Ctrl-C, because processes started in the background ignore SIGINT."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Return a function that runs a command and returns exit code, stdout and stderr."""

    def run_command(*arguments: object) -> tuple[int, str, str]:
        code = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return run_command


class Terminal(StringIO):
    """A terminal that acts when a word, such as the name of a stage of a computation, is first written."""

    def __init__(self, word: str, action: Callable[[], None]) -> None:
        super().__init__()
        self._word, self._action = word, action
        self._is_done = False

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        if self._word in text and not self._is_done:
            self._is_done = True
            self._action()
        return super().write(text)


@pytest.fixture
def run_in_terminal(run: Run, monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[int, str, str]]:
    """Return a function that runs a command in a terminal, with an action when a word is first written.

    The function returns exit code, stdout and the last line of stderr.
    """
    monkeypatch.setenv("TERM", "xterm")

    def run_command(word: str, action: Callable[[], None], *arguments: object) -> tuple[int, str, str]:
        terminal = Terminal(word, action)
        with redirect_stderr(terminal):
            code, out, _ = run(*arguments)
        return code, out, terminal.getvalue().splitlines()[-1]

    return run_command
