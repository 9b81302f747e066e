"""Fill the templates of HTML pages in this folder, which share their head and a style."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from string import Template

from plots.pictures.provenance import program_version
from plots.texts.page_colours import page_colours

QUIET_POLICY = "default-src 'none'; img-src 'self'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
"""Content-security policy of a page without scripts, with pictures of its folder."""

_FOLDER = Path(__file__).parent
_CITATION = "Computed with Escape Explorer, which implements the system of Zotos (2014), Nonlinear Dynamics 78, 1389."


def fill_page(template: str, parts: Mapping[str, object], **more_parts: object) -> str:
    """Return the HTML of a template, given the HTML of its parts, with style, citation and version of the program."""
    known = {**parts, **more_parts, "citation": _CITATION}
    style = page_colours() + _read("page.css")
    head = Template(_read("page_head.html")).substitute(known, style=style, generator=program_version())
    return Template(_read(f"{template}.html")).substitute(known, head=head)


def _read(name: str) -> str:
    """Return the text of a file in this folder."""
    return (_FOLDER / name).read_text(encoding="utf-8").rstrip()
