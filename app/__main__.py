"""Program ``python -m app``: `panel serve` for this folder, with the given options and the timeouts of a public server."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path

from app.runtime.settings import read_settings
from app.server.lifecycle.start_checks import INVALID_SETTING

SESSION_SECONDS = 60
"""Lifetime of a session without a connection, in seconds. A slow browser has this time to connect after it has got the page."""

KEEP_ALIVE_SECONDS = 20
"""Interval between pings on an idle connection, in seconds; shorter than the usual timeouts of proxies."""


def serve(options: Sequence[str]) -> None:
    """Serve the page until Ctrl-C or SIGTERM; an invalid setting ends the process with one sentence."""
    # `app_hooks` would report an invalid setting only after the import of Panel, which takes seconds.
    try:
        read_settings(os.environ)
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(INVALID_SETTING)
    from panel.command import main

    # Panel reads its command line from the arguments of the process.
    sys.argv = ["panel", *serve_arguments(), *options]
    main()


def serve_arguments() -> list[str]:
    """Return the command of Panel that serves this folder."""
    return [
        "serve",
        str(Path(__file__).parent),
        f"--unused-session-lifetime={1000 * SESSION_SECONDS}",
        f"--keep-alive={1000 * KEEP_ALIVE_SECONDS}",
    ]


if __name__ == "__main__":
    serve(sys.argv[1:])
