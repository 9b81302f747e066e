"""Fixtures of the tests of the command line."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator

import pytest

from cli.main import main

Run = Callable[..., tuple[int, str, str]]
"""Runs a command; its exit code, stdout and stderr."""


@pytest.fixture(autouse=True)
def default_sigint() -> Iterator[None]:
    """Python's own handler of Ctrl-C; processes started in the background inherit an ignored SIGINT."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Function that runs a command and returns its exit code, stdout and stderr."""

    def run_command(*arguments: object) -> tuple[int, str, str]:
        code = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return run_command
