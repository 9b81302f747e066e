"""Program ``python -m app``: `panel serve` for this folder, with the times in the settings and the options of that command."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path

from app.runtime.settings import Settings, read_settings
from app.server.start_checks import INVALID_SETTING


def serve(options: Sequence[str]) -> None:
    """Serve the page until Ctrl-C or SIGTERM; an invalid setting ends the process with one sentence."""
    # The hooks of the page report it only after Panel is imported, which takes seconds.
    try:
        settings = read_settings(os.environ)
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(INVALID_SETTING)
    from panel.command import main

    # Panel reads the arguments of the process.
    sys.argv = ["panel", *serve_arguments(settings), *options]
    main()


def serve_arguments(settings: Settings) -> list[str]:
    """The command of Panel that serves this folder."""
    return [
        "serve",
        str(Path(__file__).parent),
        f"--unused-session-lifetime={1000 * settings.session_seconds}",
        f"--keep-alive={1000 * settings.keep_alive_seconds}",
    ]


if __name__ == "__main__":
    serve(sys.argv[1:])
