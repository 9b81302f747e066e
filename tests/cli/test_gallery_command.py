"""Command ``gallery`` writes a folder of figures."""

from __future__ import annotations

import json
from pathlib import Path

from tests.cli.conftest import Run


def test_the_chosen_views_are_written_with_a_page_that_lists_them(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("gallery", tmp_path / "course", "--only", "two-exits", "--resolution", 16, "--json")
    answer = json.loads(out)
    assert code == 0
    assert r"16 \u00d7 16 pixels" in (tmp_path / "course" / "two-exits.html").read_text()
    assert answer["stills"] == {"two-exits": ""}
    assert {Path(name).name for name in answer["files"]} == {"index.html", "live.js", "two-exits.html", "two-exits.png"}
    assert {file.name for file in (tmp_path / "course").iterdir()} == {"index.html", "live.js", "two-exits.html", "two-exits.png"}


def test_an_unknown_view_is_refused_before_anything_is_written(run: Run, tmp_path: Path) -> None:
    code, _, error = run("gallery", tmp_path / "course", "--only", "sun")
    assert code == 2
    assert "only='sun': must be one of two-exits, " in error
    assert not (tmp_path / "course").exists()
