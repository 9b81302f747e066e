"""The code that embeds a view, and the link that leads from the frame to the whole page."""

from __future__ import annotations

import re
from html import unescape
from urllib.parse import parse_qsl, urlsplit

import pytest

from app.state.permalink import read_link
from app.state.view_state import ViewState
from app.views.panels.embedding import OpenLink, embed_code
from engine import Plane

ADDRESS = "https://maps.example.org/deep/app"


def source(code: str) -> str:
    """The address in the code of a frame."""
    found = re.fullmatch(r'<iframe src="([^"]*)" [^>]*></iframe>', code)
    assert found is not None
    return unescape(found[1])


@pytest.mark.parametrize(("focus", "picture"), [("", "basins"), ("times", "times")])
def test_the_frame_shows_the_picture_that_is_large_or_else_the_basins(focus: str, picture: str) -> None:
    state = ViewState(case="III", energy=0.4, plane=Plane.X_Y, focus=focus)
    address = source(embed_code(ADDRESS, state))
    assert address.startswith(f"{ADDRESS}?case=III&plane=x_y&h=0.4&")
    assert f"embed={picture}" in urlsplit(address).query.split("&")


def test_the_frame_shows_the_view() -> None:
    state = ViewState(case="III", energy=0.4, starts=((0.1, 0.2),), judge=True)
    values, problems = read_link(dict(parse_qsl(urlsplit(source(embed_code(ADDRESS, state))).query)))
    assert problems == []
    assert ViewState(**values).map_spec() == state.map_spec()
    assert (values["starts"], values["judge"]) == (((0.1, 0.2),), True)


def test_texts_are_no_markup() -> None:
    link = OpenLink()
    link.show('?V="><script>')
    assert "<script>" not in link.pane.object
