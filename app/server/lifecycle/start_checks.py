"""Checks before the server starts. A violation ends the process with one sentence and exit code 2."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

INVALID_SETTING = 2
"""Exit code of a process that an invalid setting ends."""

SEVERAL_PROCESSES = (
    "--num-procs: must be 1, as requests of a page could reach a process without its session; "
    "start one server per port behind a proxy with sticky sessions instead (docs/operation.md)"
)


def refuse_to_start(sentence: str) -> NoReturn:
    """Write the sentence to stderr and end the process."""
    sys.stderr.write(f"{sentence}\n")
    sys.stderr.flush()
    # SystemExit would first run the hooks that stop a server, but no server has started.
    os._exit(INVALID_SETTING)


def asks_for_several_processes(arguments: Sequence[str]) -> bool:
    """Whether the arguments of `panel serve` ask for more than one process. ``--num-procs=0`` asks for one per core."""
    parser = argparse.ArgumentParser(add_help=False, exit_on_error=False)
    parser.add_argument("--num-procs", type=int, default=1)
    # All arguments after this option belong to the application.
    parser.add_argument("--args", nargs=argparse.REMAINDER)
    try:
        return bool(parser.parse_known_args(arguments)[0].num_procs != 1)
    except argparse.ArgumentError:
        # `panel serve` reports the error.
        return False
