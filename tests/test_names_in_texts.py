"""Names in backticks, in docstrings of public names and in documents, exist."""

from __future__ import annotations

import ast
import inspect
import re
import subprocess
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import engine
from engine import results

ROOT = Path(__file__).parents[1]
PAGES = [page for page in [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")] if page.name != "CHANGELOG.md"]
PUBLIC = {name: getattr(module, name) for module in (engine, results) for name in module.__all__}
NAME = re.compile(r"(?<!`)`([A-Za-z_]\w*(?:\.\w+)*)(?:\([^`\n]*\))?`(?!`)")

FOREIGN = re.compile(
    r"BOKEH_\w+|PANEL_\w+|(?:asyncio|concurrent|datashader|matplotlib|np|numpy|pandas|zlib)\.[\w.]+"
    # Names of Bokeh, Panel, nginx and the files of this project.
    r"|Application\._set_session_prefix|ComponentResourceHandler\.parse_url_path|OAuthProvider\.get_user_async"
    r"|_BytesDecoder\.bytes_object_hook|_dispatch_msgs|auth_basic|get_token_payload|secret_key_bytes|settings\.sign_sessions"
    r"|kernels\.wasm"
    # Attributes of the result of a function, which the docstring of the function explains, and the example of CONTRIBUTING.
    r"|bytes|conclusion|orbits|seconds|LateMap"
)


def members(name: str, thing: Any) -> Iterator[tuple[str, Any]]:
    """Yield a public name, and for a class its public functions and properties."""
    yield name, thing
    inner = {"inner_names", *getattr(thing, "inner_names", ())}
    for attribute, member in vars(thing).items() if inspect.isclass(thing) else ():
        function = member.fget if isinstance(member, property) else getattr(member, "__func__", member)
        if inspect.isfunction(function) and not attribute.startswith("_") and attribute not in inner:
            yield f"{name}.{attribute}", function


def attributes(thing: Any) -> set[str]:
    """Return the attributes of a thing and, if it can be called, its parameters."""
    fields = getattr(thing, "__dataclass_fields__", {})
    own = object.__dir__(thing) if not inspect.isclass(thing) else [name for base in thing.__mro__ for name in vars(base)]
    call = thing if inspect.isfunction(thing) else getattr(thing, "__init__", None)
    return {*own, *fields, *(inspect.signature(call).parameters if inspect.isfunction(call) else ())}


def is_known(name: str, near: Any) -> bool:
    first, *rest = name.split(".")
    if first in PUBLIC:
        return not rest or rest[0] in attributes(PUBLIC[first])
    return bool(FOREIGN.fullmatch(name)) or any(first in attributes(each) for each in (near, *PUBLIC.values()))


@pytest.mark.parametrize("name", PUBLIC)
def test_docstrings_name_what_a_user_can_find(name: str) -> None:
    found = [
        f"{place}: {named}"
        for place, thing in members(name, PUBLIC[name])
        for named in NAME.findall(thing.__doc__ or "")
        if not is_known(named, thing)
    ]
    assert found == []


@cache
def words_of_the_source() -> set[str]:
    """Return all names and short texts of the programs, and the names of the files."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    words = {part for file in listed for part in (*Path(file).parts, Path(file).stem)}
    for file in listed:
        text = (ROOT / file).read_text(encoding="utf-8") if file.endswith((".py", ".js", ".ts")) else ""
        if not file.endswith(".py"):
            words.update(re.findall(r"\w+", text))
            continue
        for node in ast.walk(ast.parse(text)):
            values = [getattr(node, key, None) for key in ("name", "id", "attr", "arg", "module", "value")]
            words.update(part for value in values if isinstance(value, str) for part in (value, *value.split(".")))
    return words | {plane.key for plane in engine.Plane}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_documents_name_what_exists(page: Path) -> None:
    prose = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    named = {name for name in NAME.findall(prose) if re.search(r"[_.]|[a-z][A-Z]", name) and not FOREIGN.fullmatch(name)}
    words = words_of_the_source()
    # Settings are variables of the environment, named after their fields in capitals.
    unknown = {
        name
        for name in named
        if name not in words
        and any(part not in words and part.removeprefix("ESCAPE_EXPLORER_").lower() not in words for part in name.split("."))
    }
    assert unknown == set()
