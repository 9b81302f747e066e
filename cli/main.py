"""The program ``escape-explorer``: its commands, and what becomes of an error."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from concurrent.futures import CancelledError
from importlib import metadata
from typing import Annotated

import typer

from cli import (
    curves_command,
    lyapunov_command,
    map_command,
    measures_command,
    orbit_command,
    potential_command,
    reproduce_command,
    serve_command,
    sweep_command,
)

NAME = "escape-explorer"

WRONG_REQUEST, WENT_WRONG, STOPPED = 2, 1, 130
"""Exit codes: what was asked cannot be; it broke on the way; Ctrl-C, as shells count it (128 + SIGINT)."""

program = typer.Typer(name=NAME, no_args_is_help=False, pretty_exceptions_enable=False, rich_markup_mode="rich")
program.command("map", epilog=map_command.EXAMPLES)(map_command.draw_map)
program.command("orbit", epilog=orbit_command.EXAMPLES)(orbit_command.follow_orbit)
program.command("lyapunov", epilog=lyapunov_command.EXAMPLES)(lyapunov_command.list_lyapunov_orbits)
program.command("measures", epilog=measures_command.EXAMPLES)(measures_command.measure_basins)
program.command("curves", epilog=curves_command.EXAMPLES)(curves_command.draw_curves)
program.command("sweep", epilog=sweep_command.EXAMPLES)(sweep_command.sweep_energies)
program.command("reproduce", epilog=reproduce_command.EXAMPLES)(reproduce_command.reproduce_paper)
program.command("potential", epilog=potential_command.EXAMPLES)(potential_command.describe_potential)
program.command("serve", epilog=serve_command.EXAMPLES)(serve_command.serve_page)


def _say_version(asked: bool) -> None:
    if asked:
        typer.echo(f"{NAME} {metadata.version(NAME)}")
        raise typer.Exit


@program.callback(epilog=f"Example:\n\n{NAME} map I --energy 0.19 --output first")
def _describe(
    version: Annotated[
        bool, typer.Option("--version", callback=_say_version, is_eager=True, help="Say the version and stop.")
    ] = False,
) -> None:
    """Escapes in open Hamiltonian systems with several exit channels: maps, orbits and measures, without a browser."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    arguments
        Those after the program's name; None for the process' own.

    Returns
    -------
    The exit code: 0; 2 when the request is at fault; 1 when something else is; 130 when stopped by Ctrl-C. In these three cases
    one sentence goes to stderr, and no file is left half written.
    """
    try:
        returned = program(arguments, prog_name=NAME, standalone_mode=False)
    except (KeyboardInterrupt, CancelledError) as stop:
        return _fail(str(stop) or "stopped before the end; nothing was written", STOPPED)
    except (typer.TyperException, ValueError) as error:
        return _fail(_words(error), WRONG_REQUEST)
    except (ImportError, OSError) as error:
        return _fail(_words(error), WENT_WRONG)
    except Exception as error:
        return _fail(f"{type(error).__name__}: {_words(error)}", WENT_WRONG)
    if returned == STOPPED:
        # Typer has caught a Ctrl-C that did not wait.
        return _fail("stopped at once", STOPPED)
    return returned if isinstance(returned, int) else 0


def _words(error: Exception) -> str:
    """An error in one line."""
    text = error.format_message() if isinstance(error, typer.TyperException) else str(error)
    return " ".join(text.split())


def _fail(sentence: str, code: int) -> int:
    sys.stderr.write(f"{NAME}: {sentence}\n")
    return code
