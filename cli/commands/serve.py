"""Serve the page until Ctrl-C or SIGTERM; environment variables ESCAPE_EXPLORER_… set its limits (docs/operation.md).

Examples:

escape-explorer serve --show

escape-explorer serve --port 8080 --address 0.0.0.0 --allow-websocket-origin maps.example.org
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path
from typing import Annotated

import typer


def run(
    *,
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port to listen on.")] = 5006,
    address: Annotated[
        str, typer.Option(help="Address of the network interface to listen on; by default this machine only.")
    ] = "127.0.0.1",
    allow_websocket_origin: Annotated[
        list[str] | None, typer.Option(metavar="HOST", help="Host whose pages may open a WebSocket; can be repeated.")
    ] = None,
    show: Annotated[bool, typer.Option("--show", help="Open the page in a browser.")] = False,
) -> None:
    """Run the program that serves the installed page."""
    if importlib.util.find_spec("panel") is None:
        # Imported here, because the engine is slow to import.
        from engine.foundations.extras import require_package

        require_package("panel", "page")
    command = serve_arguments(port, address, allow_websocket_origin or [], show)
    environment = server_environment()
    if os.name == "posix":
        # Replace this process, so that signals reach the server.
        os.execve(command[0], command, environment)
    raise typer.Exit(subprocess.call(command, env=environment))


def serve_arguments(port: int, address: str, origins: list[str], show: bool) -> list[str]:
    """Return the command that starts the server.

    With the option -P, Python does not import a folder named app in the working directory.
    """
    command = [sys.executable, "-P", "-m", app_package(), "--port", str(port), "--address", address]
    command += [f"--allow-websocket-origin={origin}" for origin in origins]
    return [*command, "--show"] if show else command


def server_environment() -> dict[str, str]:
    """Return the environment of this process with a PYTHONPATH that contains the installed packages."""
    # The folder that contains the top-level package of this module.
    root = Path(__file__).parents[__name__.count(".")]
    paths = [str(root), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}


def app_package() -> str:
    """Return the name of the installed package of the page. The package is a program of its own, so it is not imported."""
    spec = importlib.util.find_spec("app")
    if spec is None:
        raise RuntimeError("the package app is not installed beside the command line")
    return spec.name
