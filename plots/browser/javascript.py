"""The code of JavaScript modules as single texts: for components, and for callbacks of Bokeh, which are bodies of functions."""

from __future__ import annotations

import re
from pathlib import Path

# An import of another module of the app, on a line.
_IMPORT = re.compile(r'^import .* from "(\.\.?/.+)"\n', re.MULTILINE)


def component_code(module: Path) -> str:
    """Return the text of a module with the modules that it imports, because a component has a single text."""
    source = module.read_text(encoding="utf-8")
    return "\n".join([*map(_strip_module_syntax, _read_imports(module, source)), _IMPORT.sub("", source)])


def callback_code(module: Path, call: str) -> str:
    """Return the functions of a module and of the modules that it imports, and a call such as ``label(tick, base)``."""
    source = module.read_text(encoding="utf-8")
    return "\n".join([*map(_strip_module_syntax, [*_read_imports(module, source), source]), f"return {call}"])


def _read_imports(module: Path, source: str) -> list[str]:
    """Return the texts of the modules that a module imports, directly or not, each once and before those that import it."""
    texts: dict[str, None] = {}
    for name in _IMPORT.findall(source):
        path = module.parent / name
        text = path.read_text(encoding="utf-8")
        texts |= dict.fromkeys([*_read_imports(path, text), text])
    return list(texts)


def _strip_module_syntax(source: str) -> str:
    """Return the code of a module without its imports, and without the word that exports a name."""
    return _IMPORT.sub("", source).replace("export ", "")
