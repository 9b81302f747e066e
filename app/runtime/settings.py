"""Server settings, read from environment variables and validated before the first request."""

from __future__ import annotations

import reprlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import Any

from engine.foundations.execution import count_cores
from engine.jobs.manager import DEFAULT_MOST_ORBITS

PREFIX = "ESCAPE_EXPLORER_"
"""Prefix of the environment variables."""

MIB = 2**20
"""Bytes in a mebibyte."""


class LogFormat(StrEnum):
    """Format of a log record."""

    TEXT = "text"
    JSON = "json"


@dataclass(frozen=True)
class _Parser:
    """Converts the text of a variable with `parse`. `legal` describes the legal values."""

    parse: Callable[[str], Any]
    legal: str


def _integer(low: int, high: int) -> _Parser:
    return _Parser(lambda text: _in_range(int(text), low, high), f"a whole number from {low} to {high}")


def _number(low: float, high: float) -> _Parser:
    return _Parser(lambda text: _in_range(float(text), low, high), f"a number from {low:g} to {high:g}")


def _in_range[Number: (int, float)](value: Number, low: Number, high: Number) -> Number:
    """Return a value from `low` to `high`; ValueError for another value, including NaN."""
    if not low <= value <= high:
        raise ValueError
    return value


def _parse_origins(text: str) -> tuple[str, ...]:
    origins = tuple(text.split())
    # Origins are written into a header, where a separator could begin another directive or header.
    if not all(origin.isascii() and origin.isprintable() and not set(origin) & set(";,'\"") for origin in origins):
        raise ValueError
    return origins


_YES_OR_NO = _Parser(lambda text: {"yes": True, "no": False}[text.lower()], "yes or no")
_LOG_FORMAT = _Parser(LogFormat, "text or json")
_ORIGINS = _Parser(_parse_origins, "origins separated by spaces")


def _setting(default: Any, parser: _Parser) -> Any:
    return field(default=default, metadata={"parser": parser})


@dataclass(frozen=True)
class Settings:
    """Settings of one server process.

    Attributes
    ----------
    largest_resolution
        Largest number of pixels along a side of a map.
    sharpest_resolution
        Largest number of pixels along a side of a map that is drawn again with more pixels, as many as its picture has on the
        screen; 0 for never.
    longest_t_max
        Largest t_max, the time until which orbits are integrated (dimensionless).
    most_orbits
        Largest number of orbits in all large running jobs: pixels of maps, and pixels times values of sweeps.
    most_sessions
        Largest number of sessions, and of WebSockets. Further requests for the page get status 503.
    pages_per_address
        Largest number of sessions, and of WebSockets, of one address (IPv6: of one network).
    most_connections
        Largest number of open connections without WebSockets. Further connections are answered with status 503.
    compiled_operations
        Largest number of compiled operations in the integrators of all potentials outside the catalogue. Compiled code stays
        loaded.
    cache_bytes
        Size limit of the result cache, in bytes. A complete map of 224 × 224 pixels takes 1.4 MB.
    memory_ceiling
        Resident memory, in bytes, above which the server reports that it is not ready; 0 for no limit.
    threads
        Number of compute threads; by default the number of cores available to the process.
    log
        Format of the log.
    processes
        Number of server processes that share the processors of the machine.
    cores_per_page
        Processors that an active visitor uses; 0 to estimate them (see `app.runtime.capacity`).
    frame_ancestors
        Origins that may embed the page in a frame; see `ancestors_at`.
    bokeh_patches
        Whether faster functions replace two functions of Bokeh (see `app.browser.bokeh_patches`).
    """

    largest_resolution: int = _setting(1024, _integer(16, 4096))
    sharpest_resolution: int = _setting(900, _integer(0, 4096))
    longest_t_max: float = _setting(1e6, _number(1.0, 1e8))
    most_orbits: int = _setting(DEFAULT_MOST_ORBITS, _integer(1000, 10**9))
    most_sessions: int = _setting(200, _integer(1, 100_000))
    pages_per_address: int = _setting(50, _integer(1, 100_000))
    most_connections: int = _setting(500, _integer(1, 100_000))
    compiled_operations: int = _setting(500_000, _integer(50_000, 10**9))
    cache_bytes: int = _setting(64 * MIB, _integer(0, 2**50))
    memory_ceiling: int = _setting(0, _integer(0, 2**50))
    threads: int = field(default_factory=count_cores, metadata={"parser": _integer(1, 1024)})
    log: LogFormat = field(default=LogFormat.TEXT, metadata={"parser": _LOG_FORMAT})
    processes: int = _setting(1, _integer(1, 1024))
    cores_per_page: float = _setting(0.0, _number(0.0, 1.0))
    frame_ancestors: tuple[str, ...] = _setting((), _ORIGINS)
    bokeh_patches: bool = _setting(True, _YES_OR_NO)

    def ancestors_at(self, host: str) -> tuple[str, ...]:
        """Return the origins that may embed the page in a frame when it has this host, without port; empty if no origin may.

        These are `frame_ancestors`. If there are none, pages of this computer may embed the page of a server that is used on it.
        """
        return self.frame_ancestors or (_LOOPBACK_ORIGINS if host in _LOOPBACK_HOSTS else ())


_LOOPBACK_HOSTS = ("127.0.0.1", "localhost")
_LOOPBACK_ORIGINS = tuple(f"http://{host}:*" for host in _LOOPBACK_HOSTS)


def variable_name(setting: str) -> str:
    """Return the environment variable of a setting."""
    return PREFIX + setting.upper()


def read_settings(environment: Mapping[str, str]) -> Settings:
    """Read the settings from environment variables. Settings of missing and empty variables keep their defaults.

    Raises
    ------
    ValueError
        If a value is invalid. The message has the variable, its value and the legal values.
    """
    values: dict[str, Any] = {}
    for setting in fields(Settings):
        variable, parser = variable_name(setting.name), setting.metadata["parser"]
        text = environment.get(variable, "")
        if not text:
            continue
        try:
            values[setting.name] = parser.parse(text)
        except (ValueError, KeyError):
            raise ValueError(f"{variable}={reprlib.repr(text)}: must be {parser.legal}") from None
    return Settings(**values)
