"""Marks for parameters of commands, used in ``Annotated``. The options follow from the marks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class DocumentedBy:
    """Gives an option the help of a parameter of a request or function. An option without a default gets the default as well.

    Attributes
    ----------
    owner
        The request or the function.
    name
        Name of the parameter; empty if the option has the same name.
    """

    owner: Callable[..., Any]
    name: str = ""


@dataclass(frozen=True)
class OptionChanges:
    """Removes options of a request from a command, or gives options other defaults."""

    without: tuple[str, ...] = ()
    defaults: Mapping[str, Any] = field(default_factory=dict)
