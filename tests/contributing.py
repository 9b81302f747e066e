"""The examples of CONTRIBUTING.md, which tests run as a part of the module that each is for."""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType
from typing import Any

_TEXT = (Path(__file__).parents[1] / "CONTRIBUTING.md").read_text(encoding="utf-8")


def run_example(heading: str, module: ModuleType) -> dict[str, Any]:
    """The names that the first block of Python under a heading defines, beside those of a module."""
    section = _TEXT.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    blocks = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    names = dict(vars(module))
    exec(blocks[0], names)
    return names
