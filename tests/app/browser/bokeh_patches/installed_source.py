"""Compare a patch file with the installed sources of Bokeh."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import bokeh

import app.browser.bokeh_patches

_INSTALLED = Path(bokeh.__file__).parent
_PATCHES = Path(app.browser.bokeh_patches.__file__).parent


def missing_hunks(patch: str) -> list[str]:
    """Return the hunks whose old lines are not in the installed file."""
    return [old for path, old in _old_hunks(_PATCHES / patch) if old not in (_INSTALLED / path).read_text()]


def _old_hunks(patch: Path) -> Iterator[tuple[str, str]]:
    for file in patch.read_text().split("--- a/src/bokeh/")[1:]:
        path, *lines = file.splitlines()
        for hunk in "\n".join(lines[1:]).split("\n@@")[0:]:
            old = [line[1:] for line in hunk.splitlines()[1:] if line[:1] in {" ", "-"}]
            yield path, "\n".join(old)
