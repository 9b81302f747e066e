"""Program ``escape-explorer``: its commands and exit codes."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from concurrent.futures import CancelledError
from importlib import metadata
from typing import Annotated

import typer

from cli import (
    curves_command,
    ensemble_command,
    lyapunov_command,
    map_command,
    measures_command,
    orbit_command,
    potential_command,
    reproduce_command,
    serve_command,
    sweep_command,
)
from cli.system_errors import describe_system_error

NAME = "escape-explorer"

INVALID_REQUEST, FAILED, INTERRUPTED = 2, 1, 130
"""Exit codes: invalid arguments; failure while running; Ctrl-C, as in shells (128 + SIGINT)."""

program = typer.Typer(name=NAME, no_args_is_help=False, pretty_exceptions_enable=False, rich_markup_mode="rich")
program.command("map", epilog=map_command.EXAMPLES)(map_command.draw_map)
program.command("orbit", epilog=orbit_command.EXAMPLES)(orbit_command.follow_orbit)
program.command("lyapunov", epilog=lyapunov_command.EXAMPLES)(lyapunov_command.list_lyapunov_orbits)
program.command("measures", epilog=measures_command.EXAMPLES)(measures_command.measure_basins)
program.command("curves", epilog=curves_command.EXAMPLES)(curves_command.draw_curves)
program.command("ensemble", epilog=ensemble_command.EXAMPLES)(ensemble_command.follow_ensemble)
program.command("sweep", epilog=sweep_command.EXAMPLES)(sweep_command.sweep_energies)
program.command("reproduce", epilog=reproduce_command.EXAMPLES)(reproduce_command.reproduce_paper)
program.command("potential", epilog=potential_command.EXAMPLES)(potential_command.describe_potential)
program.command("serve", epilog=serve_command.EXAMPLES)(serve_command.serve_page)


def _print_version(requested: bool) -> None:
    if requested:
        typer.echo(f"{NAME} {metadata.version(NAME)}")
        raise typer.Exit


@program.callback(epilog=f"Example:\n\n{NAME} map I --energy 0.19 --output first")
def _describe(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Escapes in open Hamiltonian systems with several exit channels: maps, orbits and measures, without a browser."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    arguments
        Arguments after the program's name; None for those of the process.

    Returns
    -------
    Exit code: 0; 2 for invalid arguments; 1 for any other error; 130 after Ctrl-C. An error prints one sentence
    to stderr and leaves no file half written.
    """
    try:
        returned = program(arguments, prog_name=NAME, standalone_mode=False)
    except (KeyboardInterrupt, CancelledError) as stop:
        return _fail(str(stop) or "interrupted; nothing was written", INTERRUPTED)
    except (typer.TyperException, ValueError) as error:
        return _fail(_message(error), INVALID_REQUEST)
    except OSError as error:
        return _fail(_on_one_line(describe_system_error(error)), FAILED)
    except ImportError as error:
        return _fail(_message(error), FAILED)
    except Exception as error:
        return _fail(f"{type(error).__name__}: {_message(error)}", FAILED)
    if returned == INTERRUPTED:
        # Typer turns a second Ctrl-C into this exit code.
        return _fail("interrupted; nothing was written", INTERRUPTED)
    return returned if isinstance(returned, int) else 0


def _message(error: Exception) -> str:
    """Return the message of an error on one line."""
    text = error.format_message() if isinstance(error, typer.TyperException) else str(error)
    return _on_one_line(text)


def _on_one_line(text: str) -> str:
    return " ".join(text.split())


def _fail(sentence: str, code: int) -> int:
    sys.stderr.write(f"{NAME}: {sentence}\n")
    return code
