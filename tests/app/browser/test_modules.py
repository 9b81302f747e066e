"""The JavaScript of the page passes its own tests in Node.js, and components are legal together with what they import."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from plots.browser.javascript import component_code
from tests.node import needs_node
from tests.waiting import SECONDS

_TESTS = Path(__file__).parents[2]
_SCRIPTS = [path for path in sorted((_TESTS.parent / "app").rglob("*.js")) if "modules" not in path.parts]
_COMPONENTS = [path for path in _SCRIPTS if "export function render" in path.read_text(encoding="utf-8")]


@needs_node
def test_the_javascript_tests_pass() -> None:
    tests = sorted(map(str, _TESTS.rglob("*.test.js")))
    done = subprocess.run(["node", "--test", *tests], capture_output=True, text=True, timeout=SECONDS, check=False)
    assert tests
    assert done.returncode == 0, done.stdout


@needs_node
@pytest.mark.parametrize("path", _COMPONENTS, ids=lambda path: path.stem)
def test_the_modules_of_a_component_declare_different_names(path: Path) -> None:
    check = ["node", "--input-type=module", "--check", "-"]
    done = subprocess.run(check, input=component_code(path), capture_output=True, text=True, timeout=SECONDS, check=False)
    assert done.returncode == 0, done.stderr
