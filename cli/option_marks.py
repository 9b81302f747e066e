"""Marks for parameters of commands, used in ``Annotated``, from which the options are made."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Of:
    """Marks an option with the help of a parameter of a request or function, and its default unless one is given.

    Attributes
    ----------
    owner
        The request or the function.
    name
        Name of the parameter there, if it differs.
    """

    owner: Callable[..., Any]
    name: str = ""


@dataclass(frozen=True)
class But:
    """Marks a request for which a command lacks the options of some parameters, or has other defaults."""

    without: tuple[str, ...] = ()
    defaults: Mapping[str, Any] = field(default_factory=dict)
