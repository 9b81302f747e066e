"""Run the program ``escape-explorer``: find and import a command, and turn errors into exit codes."""

from __future__ import annotations

import inspect
import re
import sys
from collections import deque
from collections.abc import Iterable, Sequence
from concurrent.futures import CancelledError
from importlib import import_module, metadata
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from cli.system_errors import describe_system_error

NAME = "escape-explorer"

INVALID_REQUEST = 2
"""Exit code for invalid arguments."""

FAILED = 1
"""Exit code for a failure while running."""

INTERRUPTED = 130
"""Exit code after Ctrl-C, as in shells: 128 + SIGINT."""

COMMANDS = (
    "map",
    "live",
    "gallery",
    "orbit",
    "lyapunov",
    "measures",
    "curves",
    "where",
    "study",
    "ensemble",
    "sweep",
    "reproduce",
    "potential",
    "versions",
    "serve",
)
"""Names of the modules in `commands`. A module is imported when its command runs."""


class _Command(TyperCommand):
    """A command whose arguments may begin with one minus, as formulas do. All its options begin with two."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the words. Those that begin with one minus are first moved behind ``--``, where all words are arguments."""
        options = self.get_params(ctx)
        value_counts = {name: _count_values(option) for option in options for name in (*option.opts, *option.secondary_opts)}
        words = deque(args)
        other_words: list[str] = []
        minus_words: list[str] = []
        while words and words[0] != "--":
            word = words.popleft()
            if re.match("-[^-]", word):
                minus_words.append(word)
                continue
            self._check_option(word.partition("=")[0], value_counts)
            other_words.append(word)
            # The values of an option may also begin with a minus.
            other_words.extend(words.popleft() for _ in range(min(value_counts.get(word, 0), len(words))))
        # `words` is empty or begins with "--".
        return super().parse_args(ctx, [*other_words, "--", *minus_words, *list(words)[1:]])

    def _check_option(self, word: str, known: Iterable[str]) -> None:
        """Raise ValueError for an unknown option. Typer would list similar names, but the wanted name may be another word."""
        names = [name for name in known if name.startswith("--")]
        if word.startswith("--") and word not in names:
            raise ValueError(f"{word}: {self.name} has no such option; its options are {', '.join(names)}")

    def get_params(self, ctx: Any) -> list[Any]:
        """Return the parameters in the form that the help shows."""
        return _without_types_of_flags(super().get_params(ctx))


def _count_values(option: Any) -> int:
    return 0 if getattr(option, "is_flag", False) else int(option.nargs)


def _without_types_of_flags(params: list[Any]) -> list[Any]:
    """Remove the type names of flags, in place, and return the parameters."""
    for option in params:
        if _count_values(option) == 0:
            option.metavar = ""
    return params


class _Commands(TyperGroup):
    """A group of commands whose modules are imported when a command runs. Until then, only the names and summaries are known."""

    def get_params(self, ctx: Any) -> list[Any]:
        """Return the parameters in the form that the help shows."""
        return _without_types_of_flags(super().get_params(ctx))

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return the name of a command, the imported command, and its words."""
        name, command, words = super().resolve_command(ctx, args)
        return name, command and _import_command(str(command.name)), words


def _import_command(name: str) -> Any:
    """Import the module of a command, and return the command. The docstring of the module is the help."""
    module = import_module(f"{__package__}.commands.{name}")
    text, _, examples = inspect.cleandoc(module.__doc__ or "").partition("Examples:")
    command_program = typer.Typer(add_completion=False, rich_markup_mode="rich")
    command_program.command(name, cls=_Command, help=text, epilog=f"Examples:{examples}")(module.run)
    return typer.main.get_command(command_program)


def _read_summary(name: str) -> str:
    """Return the first line of a module's docstring, without importing the module."""
    with Path(__file__).with_name("commands").joinpath(f"{name}.py").open(encoding="utf-8") as source:
        return source.readline().strip().strip('"')


program = typer.Typer(name=NAME, cls=_Commands, no_args_is_help=False, pretty_exceptions_enable=False, rich_markup_mode="rich")
# The help of the program shows the summaries. `_Commands` replaces these empty functions by the imported commands.
for _name in COMMANDS:
    program.command(_name, help=_read_summary(_name))(lambda: None)


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
    Exit code: 0, or 2 for invalid arguments, 1 for any other error, 130 after Ctrl-C. After an error, one sentence is on stderr,
    and no file is half written.
    """
    try:
        exit_code = program(arguments, prog_name=NAME, standalone_mode=False)
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
    if exit_code == INTERRUPTED:
        # After a second Ctrl-C, Typer returns this exit code instead of raising KeyboardInterrupt.
        return _fail("interrupted", INTERRUPTED)
    return exit_code if isinstance(exit_code, int) else 0


def _message(error: Exception) -> str:
    """Return the message of an error, on one line."""
    text = error.format_message() if isinstance(error, typer.TyperException) else str(error)
    return _on_one_line(text)


def _on_one_line(text: str) -> str:
    """Return a text on one line. Control characters, which could change the terminal, are escaped."""
    line = " ".join(text.split())
    return "".join(each if each.isprintable() else ascii(each)[1:-1] for each in line)


def _fail(sentence: str, code: int) -> int:
    sys.stderr.write(f"{NAME}: {sentence}\n")
    return code
