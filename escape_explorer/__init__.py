"""Escapes in open Hamiltonian systems: the public names of `engine`, and `Explorer`, the page in a notebook.

In the repository this package has three files only, two of them entry points; the wheel contains the other packages of the
repository below it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from app.session.notebook import Explorer as Explorer
    from engine import *  # noqa: F403


def __getattr__(name: str) -> Any:
    """Names are imported at their first use, so that the command line starts without the compiler."""
    if name == "Explorer":
        import_module("engine.foundations.extras").require_package("panel", "page")
        return import_module("app.session.notebook").Explorer
    engine = import_module("engine")
    if name == "__all__":
        return engine.__all__
    if name in engine.FORMER_NAMES:
        return engine.find_former_name(name, stacklevel=3)
    if name not in engine.__all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(engine, name)


def __dir__() -> list[str]:
    return sorted([*__getattr__("__all__"), "Explorer"])
