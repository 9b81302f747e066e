"""The code of a component contains each module that it imports, directly or not, once and before its use."""

from __future__ import annotations

from pathlib import Path

from plots.browser.javascript import callback_code, component_code


def write_modules(folder: Path) -> Path:
    """Write a module that imports two others, of which one imports the other, and return its path."""
    texts = {
        "base": "export const base = 1\n",
        "middle": 'import {base} from "./base.js"\nexport const middle = base + 1\n',
        "top": 'import {middle} from "./middle.js"\nimport {base} from "./base.js"\nexport const top = middle + base\n',
    }
    for name, text in texts.items():
        (folder / f"{name}.js").write_text(text)
    return folder / "top.js"


def test_a_component_contains_each_module_once_and_exports_its_own_names(tmp_path: Path) -> None:
    lines = component_code(write_modules(tmp_path)).split("\n")
    assert [line for line in lines if line] == ["const base = 1", "const middle = base + 1", "export const top = middle + base"]


def test_a_callback_contains_each_module_once_and_returns_its_call(tmp_path: Path) -> None:
    lines = callback_code(write_modules(tmp_path), "top").split("\n")
    assert [line for line in lines if line] == [
        "const base = 1",
        "const middle = base + 1",
        "const top = middle + base",
        "return top",
    ]
