"""Fill the templates of HTML pages in this folder, which share a style."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from string import Template

from plots.pictures.provenance import program_version

QUIET_POLICY = "default-src 'none'; img-src 'self'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
"""Content-security policy of a page without scripts, with pictures of its folder."""

_FOLDER = Path(__file__).parent
_CITATION = "Computed with Escape Explorer, which implements the system of Zotos (2014), Nonlinear Dynamics 78, 1389."


def fill_page(template: str, parts: Mapping[str, object], **more_parts: object) -> str:
    """Return the HTML of a template, given the HTML of its parts, with style, citation and version of the program."""
    text = (_FOLDER / f"{template}.html").read_text(encoding="utf-8")
    style = (_FOLDER / "page.css").read_text(encoding="utf-8").rstrip()
    return Template(text).substitute(parts, **more_parts, style=style, citation=_CITATION, generator=program_version())
