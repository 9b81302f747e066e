"""The JavaScript of the page passes its own tests, which Node.js runs."""

from __future__ import annotations

import subprocess

from tests.node import SCRIPTS, needs_node
from tests.waiting import SECONDS


@needs_node
def test_the_javascript_tests_pass() -> None:
    tests = sorted(map(str, SCRIPTS.parent.rglob("*.test.js")))
    done = subprocess.run(["node", "--test", *tests], capture_output=True, text=True, timeout=SECONDS, check=False)
    assert tests
    assert done.returncode == 0, done.stdout
