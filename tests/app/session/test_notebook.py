from __future__ import annotations

import re
import threading
import urllib.request
from collections.abc import Iterator

import pytest

from app.session.notebook import Explorer
from engine import CASES, MapSpec, Plane, Window

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.36, (224, 224), Window(-0.4, 0.4, -0.3, 0.3), t_max=1e4)


@pytest.fixture
def explorer() -> Iterator[Explorer]:
    explorer = Explorer(SPEC, height=500)
    yield explorer
    explorer.close()
    for thread in threading.enumerate():
        if thread.name == "explorer":
            thread.join(10.0)


def test_frame_in_the_cell_opens_the_page_at_the_map(explorer: Explorer) -> None:
    frame = explorer._repr_html_()
    assert "height:500px" in frame
    (address,) = re.findall(r"src='([^']*)'", frame)
    assert "case=III&amp;plane=x_px&amp;h=0.36&amp;t_max=10000&amp;resolution=224&amp;window=-0.4,0.4,-0.3,0.3" in address
    assert explorer.map is None
    with urllib.request.urlopen(explorer.address, timeout=60) as page:
        assert page.status == 200
    assert explorer._session is not None
    assert explorer._session.state.map_spec() == SPEC
    assert explorer.orbits == ()
