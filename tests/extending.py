"""Run the examples of docs/extending.md as a part of the modules for which they are written."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

_TEXT = (Path(__file__).parents[1] / "docs" / "extending.md").read_text(encoding="utf-8")


def example_colours(key: str) -> list[tuple[str, ...]]:
    """Return the colours of a kind of outcome in each palette, in order."""
    return [tuple(re.findall("#[0-9a-f]{6}", colours)) for colours in re.findall(rf'`"{key}": \((.*?)\)`', _TEXT)]


def run_example(heading: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the given names and the names that the Python code under a heading defines."""
    names = dict(given)
    exec(example_text(heading), names)
    return names


def example_text(heading: str, language: str = "python") -> str:
    """Return the code in a language under a heading."""
    section = _TEXT.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    return "\n".join(re.findall(rf"^```{language}\n(.*?)^```$", section, re.MULTILINE | re.DOTALL))
