"""Print the patterns of all routes that `panel serve app` mounts, in order of precedence, one on each line."""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bokeh.server.server import Server
from panel.command.serve import Serve
from tornado.routing import PathMatches, RuleRouter

from tests.waiting import SECONDS

ROOT = Path(__file__).parents[3]


def mounted_routes() -> list[str]:
    """Return the patterns, listed by a separate process."""
    command = [sys.executable, "-m", "tests.app.server.mounted_routes"]
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True, timeout=SECONDS).stdout.splitlines()


class ListRoutes(Serve):
    """Runs `panel serve` until the server would start."""

    def customize_server(self, server: Server) -> Server:
        """Print the routes of its web application, and exit."""
        sys.stdout.writelines(f"{pattern}\n" for pattern in patterns(server._tornado.default_router))
        sys.stdout.flush()
        raise SystemExit(0)


def patterns(router: RuleRouter) -> Iterator[str]:
    """Yield the patterns of paths in a router and in its inner routers."""
    for rule in router.rules:
        if isinstance(rule.target, RuleRouter):
            yield from patterns(rule.target)
        elif isinstance(rule.matcher, PathMatches):
            yield rule.matcher.regex.pattern.removesuffix("$")
        else:
            raise TypeError(f"{rule.matcher} is not a path")


def main() -> None:
    parser: Any = argparse.ArgumentParser()
    command = ListRoutes(parser=parser)
    command.invoke(parser.parse_args(["app", "--port", "0", "--address", "127.0.0.1"]))


if __name__ == "__main__":
    main()
