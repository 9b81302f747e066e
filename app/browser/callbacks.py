"""JavaScript of this folder for components, and for Bokeh's callbacks, which are bodies of functions."""

from __future__ import annotations

import re
from pathlib import Path

_IMPORT = re.compile(r'^import .* from "\./(.+)"\n', re.MULTILINE)


def module_path(module: str) -> Path:
    """Path of a module of this folder, for a component."""
    return Path(__file__).with_name(module)


def component_code(module: str) -> str:
    """A module of this folder for a component, together with those that it imports: a component is one text."""
    source = module_path(module).read_text(encoding="utf-8")
    imported = (module_path(name).read_text(encoding="utf-8").replace("export ", "") for name in _IMPORT.findall(source))
    return "\n".join([*imported, _IMPORT.sub("", source)])


def callback_code(module: str, call: str) -> str:
    """The functions of a module of this folder, and a call of one of them, such as ``label(tick, base)``."""
    source = module_path(module).read_text(encoding="utf-8")
    return f"{source.replace('export function', 'function')}\nreturn {call}"
