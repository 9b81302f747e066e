"""The code to embed a view shows one picture, with a link to the whole page."""

from __future__ import annotations

import re
from html import unescape
from urllib.parse import parse_qsl, urlsplit

import pytest

from app.state.permalink import read_link
from app.state.view_state import ViewState
from app.views.panels.embedding import OpenLink, embed_code
from engine import Plane, System

ADDRESS = "https://maps.example.org/deep/app"


def source(code: str) -> str:
    """Return the address in the code of a frame."""
    found = re.fullmatch(r'<iframe src="([^"]*)" [^>]*></iframe>', code)
    assert found is not None
    return unescape(found[1])


@pytest.mark.parametrize(("focus", "picture"), [("", "basins"), ("times", "times")])
def test_the_frame_shows_the_view_and_its_large_picture_or_else_the_basins(focus: str, picture: str) -> None:
    state = ViewState(
        system=System("III"), energy=0.4, plane=Plane.X_Y, focus=focus, starts=((0.1, 0.2),), layers=frozenset({"judge"})
    )
    address = source(embed_code(ADDRESS, state))
    values, problems = read_link(dict(parse_qsl(urlsplit(address).query)))
    assert address.startswith(f"{ADDRESS}?")
    assert problems == []
    assert ViewState(**values).map_spec() == state.map_spec()
    assert (values["focus"], values["starts"], values["layers"]) == (picture, ((0.1, 0.2),), {"judge"})


def test_texts_are_escaped() -> None:
    link = OpenLink()
    link.show('?V="><script>')
    assert "<script>" not in link.pane.object
