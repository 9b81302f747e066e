"""Run scripts for Node.js, which stand beside the tests of app/browser."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

SCRIPTS = Path(__file__).parent / "app" / "browser"

needs_node = pytest.mark.skipif(shutil.which("node") is None, reason="Node.js is not installed")


def run_node(script: str, data: dict[str, Any], folder: Path) -> Any:
    """What a script prints as JSON, given data as JSON; bytes become files in `folder` and their paths."""
    for name, value in data.items():
        if isinstance(value, bytes):
            (folder / name).write_bytes(value)
            data[name] = str(folder / name)
    (folder / "input.json").write_text(json.dumps(data))
    command = ["node", str(SCRIPTS / script), str(folder / "input.json")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
