"""The JavaScript of the page passes its own tests, which Node.js runs."""

from __future__ import annotations

import subprocess
from pathlib import Path

from tests.node import needs_node
from tests.waiting import SECONDS

_TESTS = Path(__file__).parents[2]


@needs_node
def test_the_javascript_tests_pass() -> None:
    tests = sorted(map(str, _TESTS.rglob("*.test.js")))
    done = subprocess.run(["node", "--test", *tests], capture_output=True, text=True, timeout=SECONDS, check=False)
    assert tests
    assert done.returncode == 0, done.stdout
