"""The process that generates and compiles code: this process or, to relieve a server, another one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

DEFINE = "define"
"""Name of a function in each generated module. Another process that receives and calls the function defines the same module."""

_call_in_process: Callable[[Callable[[], Any]], Any] | None = None


def compile_in(call_in_process: Callable[[Callable[[], Any]], Any] | None) -> None:
    """Let another process that shares the cache on disk generate and compile code.

    Parameters
    ----------
    call_in_process
        Sends a function to the other process with cloudpickle, calls it there, and returns its result. Raises a ValueError if
        that fails. None to generate and compile in this process.
    """
    global _call_in_process
    _call_in_process = call_in_process


def compiles_here() -> bool:
    """Return whether this process generates and compiles code."""
    return _call_in_process is None


def call_compiler[Result](function: Callable[[], Result]) -> Result:
    """Call a function in the process that compiles; ValueError, with the reason, if the other process cannot."""
    return function() if _call_in_process is None else _call_in_process(function)
