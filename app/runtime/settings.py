"""What whoever runs the server may set: environment variables, read once and checked before anything is served."""

from __future__ import annotations

import os
import reprlib
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum
from functools import cache
from typing import Any

from engine import MOST_REQUESTS, count_cores

PREFIX = "ESCAPE_EXPLORER_"
"""With what the names of the environment variables begin."""

MIB = 2**20


class LogFormat(StrEnum):
    """How a line of the log is written."""

    TEXT = "text"
    JSON = "json"


@dataclass(frozen=True)
class _Reading:
    """How the text of a variable becomes a value, and what is legal, in words."""

    read: Callable[[str], Any]
    legal: str


def _whole(low: int, high: int) -> _Reading:
    return _Reading(lambda text: _within(int(text), low, high), f"a whole number from {low} to {high}")


def _number(low: float, high: float) -> _Reading:
    return _Reading(lambda text: _within(float(text), low, high), f"a number from {low:g} to {high:g}")


def _within[Number: (int, float)](value: Number, low: Number, high: Number) -> Number:
    if not low <= value <= high:
        raise ValueError
    return value


def _read_framers(text: str) -> tuple[str, ...]:
    framers = tuple(text.split())
    # What ends a directive, or a header, would begin another one.
    if not all(framer.isascii() and framer.isprintable() and not set(framer) & set(";,'\"") for framer in framers):
        raise ValueError
    return framers


_SWITCH = _Reading(lambda text: {"yes": True, "no": False}[text.lower()], "yes or no")
_LOG_FORMATS = _Reading(LogFormat, "text or json")
_FRAMERS = _Reading(_read_framers, "origins with spaces between")


def _set(default: Any, reading: _Reading) -> Any:
    made = {"default_factory": default} if callable(default) else {"default": default}
    return field(**made, metadata={"reading": reading})


@dataclass(frozen=True)
class Settings:
    """Limits and habits of one server process.

    Attributes
    ----------
    largest_resolution
        Most pixels along a side of a map that a visitor may ask for.
    longest_t_max
        Longest time horizon that a visitor may ask for, dimensionless.
    most_orbits
        Most orbits of all large jobs under way together: pixels of maps, and pixels times energies of sweeps.
    jobs_per_session
        Most jobs of one visitor at a time.
    most_sessions
        Most visitors at a time; the next one is asked to come back later.
    cache_bytes
        Most memory for results that are kept, in bytes.
    memory_ceiling
        Resident memory from which on the server calls itself not ready, in bytes; 0 for no ceiling.
    threads
        Threads that compute; without it, one for each core of this process.
    only_idle
        Whether these run only while a processor has nothing else to do (Linux): in a crowd nobody is answered late because of
        somebody's map, but another program that keeps all processors busy stops every map.
    log
        How a line of the log is written.
    session_seconds
        How long a session without a visitor is kept, in seconds: a connection that breaks may come back within it.
    keep_alive_seconds
        Time between two pings through an idle connection, in seconds; less than the patience of any proxy on the way.
    frame_ancestors
        Origins whose pages may show this one in a frame; empty for none.
    """

    largest_resolution: int = _set(1024, _whole(16, 4096))
    longest_t_max: float = _set(1e6, _number(1.0, 1e8))
    most_orbits: int = _set(4 * MIB, _whole(1000, 10**9))
    jobs_per_session: int = _set(MOST_REQUESTS, _whole(1, 1000))
    most_sessions: int = _set(200, _whole(1, 100_000))
    cache_bytes: int = _set(512 * MIB, _whole(0, 2**50))
    memory_ceiling: int = _set(0, _whole(0, 2**50))
    threads: int = _set(count_cores, _whole(1, 1024))
    only_idle: bool = _set(False, _SWITCH)
    log: LogFormat = field(default=LogFormat.TEXT, metadata={"reading": _LOG_FORMATS})
    session_seconds: int = _set(60, _whole(1, 86_400))
    keep_alive_seconds: int = _set(20, _whole(1, 3600))
    frame_ancestors: tuple[str, ...] = _set((), _FRAMERS)


def variable_of(name: str) -> str:
    """The environment variable of a setting."""
    return PREFIX + name.upper()


def read_settings(environment: Mapping[str, str]) -> Settings:
    """The settings that an environment holds; what is not there, or empty, has its default.

    Raises
    ------
    ValueError
        One sentence with the variable, its value and what is legal.
    """
    values: dict[str, Any] = {}
    for setting in fields(Settings):
        variable, reading = variable_of(setting.name), setting.metadata["reading"]
        text = environment.get(variable, "")
        if not text:
            continue
        try:
            values[setting.name] = reading.read(text)
        except (ValueError, KeyError):
            raise ValueError(f"{variable}={reprlib.repr(text)}: must be {reading.legal}") from None
    return Settings(**values)


@cache
def current_settings() -> Settings:
    """The settings of this process, which ends here, with a sentence and exit code 2, where one is of no use."""
    try:
        return read_settings(os.environ)
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(2)
