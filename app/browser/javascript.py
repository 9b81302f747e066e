"""Texts of JavaScript modules for components, and for callbacks of Bokeh, which are the body of a function."""

from __future__ import annotations

import re
from pathlib import Path

_IMPORT = re.compile(r'^import .* from "(\.\.?/.+)"\n', re.MULTILINE)


def component_code(module: Path) -> str:
    """Return the text of a module with the modules that it imports, because a component has a single text."""
    source = module.read_text(encoding="utf-8")
    return "\n".join([*map(_functions, _imported(module, source)), _IMPORT.sub("", source)])


def callback_code(module: Path, call: str) -> str:
    """Return the functions of a module and of the modules that it imports, and a call such as ``label(tick, base)``."""
    source = module.read_text(encoding="utf-8")
    return "\n".join([*map(_functions, [*_imported(module, source), source]), f"return {call}"])


def _imported(module: Path, source: str) -> list[str]:
    return [(module.parent / name).read_text(encoding="utf-8") for name in _IMPORT.findall(source)]


def _functions(source: str) -> str:
    return _IMPORT.sub("", source).replace("export ", "")
