"""The code of JavaScript modules as single texts: for components, for callbacks of Bokeh, and for pages that are one file."""

from __future__ import annotations

import json
import re
from pathlib import Path

# An import of another module of the app, on a line.
_IMPORT = re.compile(r'^import .* from "(\.\.?/.+)"\n', re.MULTILINE)
# The names of an import, the name of an export, and comments on lines of their own.
_IMPORTED = re.compile(r'^import (\{.*?\}) from "(\.\.?/.+?)"\n', re.MULTILINE | re.DOTALL)
_EXPORTED = re.compile(r"^export (?:async )?(?:function|class|const) (\w+)", re.MULTILINE)
_COMMENT = re.compile(r"^ *(?:/\*\*.*?\*/|//.*?)\n", re.MULTILINE | re.DOTALL)


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


def script_code(module: Path) -> str:
    """Return a module and the modules that it imports as a script without comments, in which each module keeps its own names."""
    functions: dict[Path, str] = {}
    _add_function(module.resolve(), functions)
    return "\n".join(["const modules = {}", *functions.values()])


def _add_function(module: Path, functions: dict[Path, str]) -> None:
    """Add the code of the modules that a module imports, and then its own, as functions that return what is exported."""
    if module in functions:
        return
    source = module.read_text(encoding="utf-8")
    for _, name in _IMPORTED.findall(source):
        _add_function((module.parent / name).resolve(), functions)
    exported = ", ".join(_EXPORTED.findall(source))

    def requirement(match: re.Match[str]) -> str:
        names = match[1].replace(" as ", ": ")
        return f"const {names} = modules[{_key((module.parent / match[2]).resolve())}]\n"

    body = _COMMENT.sub("", _IMPORTED.sub(requirement, source)).replace("export ", "")
    functions[module] = f"modules[{_key(module)}] = (() => {{\n{body}return {{{exported}}}\n}})()"


def _key(module: Path) -> str:
    """Return the key of a module: its folder and name, which are its own."""
    return json.dumps(f"{module.parent.name}/{module.stem}")
