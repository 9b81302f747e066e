"""Classes of the results that functions of the library return, for annotations and `isinstance`."""

from engine.results import *  # noqa: F403
from engine.results import __all__ as __all__  # type: ignore[attr-defined]  # mypy does not read computed names
