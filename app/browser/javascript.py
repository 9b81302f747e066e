"""Reads JavaScript modules for components, and for callbacks of Bokeh, which contain only the body of a function."""

from __future__ import annotations

import re
from pathlib import Path

_IMPORT = re.compile(r'^import .* from "\./(.+)"\n', re.MULTILINE)


def component_code(module: Path) -> str:
    """Return the text of a module and of the modules of its folder that it imports, because a component has one text."""
    source = module.read_text(encoding="utf-8")
    imported = (module.with_name(name).read_text(encoding="utf-8").replace("export ", "") for name in _IMPORT.findall(source))
    return "\n".join([*imported, _IMPORT.sub("", source)])


def callback_code(module: Path, call: str) -> str:
    """Return the functions of a module and a call of one of them, such as ``label(tick, base)``."""
    source = module.read_text(encoding="utf-8")
    return f"{source.replace('export function', 'function')}\nreturn {call}"
