"""A single text contains each module that a module imports, directly or not, once and before its use."""

from __future__ import annotations

import subprocess
from pathlib import Path

from plots.browser.javascript import callback_code, component_code, script_code
from tests.node import needs_node
from tests.waiting import SECONDS


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


@needs_node
def test_the_modules_of_a_script_keep_their_own_names(tmp_path: Path) -> None:
    (tmp_path / "one.js").write_text("/** A word. */\nconst word = 1\nexport function read() {\n  return word\n}\n")
    (tmp_path / "other.js").write_text("// A word.\nconst word = 2\nexport const read = () => word\n")
    top = tmp_path / "top.js"
    top.write_text(
        'import {read} from "./one.js"\nimport {read as readOther} from "./other.js"\nconsole.log(read(), readOther())\n'
    )
    script = script_code(top)
    printed = subprocess.run(["node", "-e", script], capture_output=True, text=True, timeout=SECONDS, check=True).stdout
    assert printed == "1 2\n"
    assert "A word" not in script
