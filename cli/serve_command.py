"""``serve``: the page in the browser, served from where the package is installed."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from app.runtime.settings import Settings

EXAMPLES = """Examples:

escape-explorer serve --show

escape-explorer serve --port 8080 --address 0.0.0.0 --allow-websocket-origin maps.example.org
"""


def serve_page(
    port: Annotated[int, typer.Option("--port", min=1, max=65535, help="Where to listen.")] = 5006,
    address: Annotated[
        str, typer.Option("--address", help="Of the network interface to listen on; without it, this machine alone.")
    ] = "127.0.0.1",
    origin: Annotated[
        list[str] | None,
        typer.Option("--allow-websocket-origin", metavar="HOST", help="Whose pages may talk to the server; once for each."),
    ] = None,
    show: Annotated[bool, typer.Option("--show", help="Open the page in a browser.")] = False,
) -> None:
    """Serve the page until Ctrl-C or SIGTERM; environment variables with the prefix ESCAPE_EXPLORER_ set its limits."""
    from app.runtime.settings import read_settings

    # Refused here already, before the seconds that a server takes to start.
    settings = read_settings(os.environ)
    command = serve_arguments(port, address, origin or [], show, settings)
    environment = server_environment()
    if os.name == "posix":
        # The server takes this process' place, so that whoever stops it stops the server.
        os.execve(command[0], command, environment)
    raise typer.Exit(subprocess.call(command, env=environment))


def serve_arguments(port: int, address: str, origins: list[str], show: bool, settings: Settings) -> list[str]:
    """The command that serves the page.

    Without -P a folder called app wherever it is started would be in the way.
    """
    command = [sys.executable, "-P", "-m", "panel", "serve", str(app_folder()), "--port", str(port), "--address", address]
    command += [f"--allow-websocket-origin={origin}" for origin in origins]
    command += [f"--unused-session-lifetime={1000 * settings.session_seconds}"]
    command += [f"--keep-alive={1000 * settings.keep_alive_seconds}"]
    return [*command, "--show"] if show else command


def server_environment() -> dict[str, str]:
    """This process' environment, in which the packages are found that it found itself."""
    paths = [str(app_folder().parent), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}


def app_folder() -> Path:
    """The folder of the package `app`, wherever it is installed."""
    spec = importlib.util.find_spec("app")
    if spec is None or not spec.submodule_search_locations:
        raise RuntimeError("the package app is not installed beside the command line")
    return Path(next(iter(spec.submodule_search_locations)))
