"""Marks for parameters of commands, used in ``Annotated``. The options follow from the marks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Of:
    """Gives an option the help of a parameter of a request or function, and the parameter's default unless another is given.

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
    """Removes options from a request in a command, or gives them other defaults."""

    without: tuple[str, ...] = ()
    defaults: Mapping[str, Any] = field(default_factory=dict)
