"""The explorer in a notebook cell opens the page at a map."""

from __future__ import annotations

import re
import threading
import urllib.request
from collections.abc import Iterator
from html import unescape
from urllib.parse import parse_qsl, urlsplit

import pytest

from app.session.notebook import Explorer
from app.state.permalink import read_link
from app.state.view_state import ViewState
from engine import CASES, MapSpec, Plane, Window
from tests.waiting import SECONDS

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.36, (224, 224), Window(-0.4, 0.4, -0.3, 0.3), t_max=1e4, section="y = 0 both")


@pytest.fixture
def explorer() -> Iterator[Explorer]:
    explorer = Explorer(SPEC, height=500)
    yield explorer
    explorer.close()
    for thread in threading.enumerate():
        if thread.name == "explorer":
            thread.join(SECONDS)


def test_frame_in_the_cell_opens_the_page_at_the_map(explorer: Explorer) -> None:
    frame = explorer._repr_html_()
    assert "height:500px" in frame
    # The content of the object, which a browser shows if it cannot reach the page, is a picture.
    assert re.search(r"'>.*data:image/png;base64,.*</object>$", frame, re.DOTALL)
    (address,) = re.findall(r"<object [^>]*data='([^']*)'", frame)
    assert unescape(address) == explorer.address
    values, problems = read_link(dict(parse_qsl(urlsplit(explorer.address).query)))
    assert (ViewState(**values).map_spec(), problems) == (SPEC, [])
    with urllib.request.urlopen(explorer.address, timeout=SECONDS) as page:
        assert "Case III on the plane (x, px) at h = 0.36" in page.read().decode()
    assert explorer.map is None
    assert explorer.orbits == ()
