"""Escapes in open Hamiltonian systems with two degrees of freedom.

The public names of the library are here: `compute_map`, `integrate_orbit`, `CASES`, ... and, where the page is installed (extra
`page`), `Explorer`, the page in a notebook. `dir(escape_explorer)` lists them. `escape_explorer.results` has the classes of the
results that functions return, for annotations. The modules `escape_explorer.engine`, `plots`, `app` and `cli` may change with any
version.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from app.session.notebook import Explorer as Explorer
    from engine import *  # noqa: F403

    __version__: str


def __getattr__(name: str) -> Any:
    """Names are imported at their first use, so that the command line starts without the compiler."""
    if name == "__version__":
        return import_module("importlib.metadata").version("escape-explorer")
    if name == "Explorer":
        import_module("engine.foundations.extras").require_package("panel", "page")
        return import_module("app.session.notebook").Explorer
    if name == "results":
        return import_module("escape_explorer.results")
    engine = import_module("engine")
    if name == "__all__":
        # Without `Explorer`, because with `import *` all of these are imported, and the page takes seconds.
        return engine.__all__
    if name not in engine.__all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(engine, name)


def __dir__() -> list[str]:
    return sorted({*import_module("engine").__all__, "Explorer", "__version__"})
