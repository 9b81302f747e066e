"""Marks of the parameters of commands, in ``Annotated``, from which their options are made."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Of:
    """Marks an option that has the help and, unless given, the default of a parameter of a request or a function.

    Attributes
    ----------
    owner
        The request or the function.
    name
        Name of the parameter there, if it is another.
    """

    owner: Callable[..., Any]
    name: str = ""


@dataclass(frozen=True)
class But:
    """Marks a request of a command without options for some of its parameters, or with other defaults."""

    without: tuple[str, ...] = ()
    defaults: Mapping[str, Any] = field(default_factory=dict)
