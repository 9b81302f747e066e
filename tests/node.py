"""Run the scripts for Node.js that are in the folder of the tests of plots/browser."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from engine.integrator.portable_kernels import kernel_module
from tests.waiting import SECONDS

_SCRIPTS = Path(__file__).parent / "plots" / "browser"

needs_node = pytest.mark.skipif(shutil.which("node") is None, reason="Node.js is not installed")


def run_node(script: str, data: dict[str, Any], folder: Path) -> Any:
    """Return what a script prints as JSON, given data as JSON. Data with a module and without kernels get the kernels.

    Bytes are written to files in `folder`, and replaced by the paths.
    """
    if "module" in data and "kernels" not in data:
        data["kernels"] = kernel_module()
    for name, value in data.items():
        if isinstance(value, bytes):
            (folder / name).write_bytes(value)
            data[name] = str(folder / name)
    (folder / "input.json").write_text(json.dumps(data))
    command = ["node", str(_SCRIPTS / script), str(folder / "input.json")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
