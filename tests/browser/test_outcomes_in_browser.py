"""In a system with two exits and a body, every part of the page that names fates names the collision with the body."""

from __future__ import annotations

import re
import urllib.parse
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from engine import MapSpec, Plane, compute_map
from tests.browser.explorer_page import ExplorerPage
from tests.disc import DISC

pytestmark = pytest.mark.browser

FORMULA = "½(x² + y²) − xy²; centre a disc (0.2, 0.3) 0.05"
LINK = f"?h=0.19&t_max=100&resolution=112&plane=x_px&analysis=watch&watch=well,1000,1,-2&V={urllib.parse.quote(FORMULA)}"


def test_a_collision_is_named_at_the_mouse_in_the_legend_the_progress_and_the_counters(
    open_explorer: Callable[..., ExplorerPage],
) -> None:
    explorer = open_explorer(link=LINK)
    explorer.wait_until_done()
    expect(explorer.text(re.compile(r"^collision with a disc\s[0-9.]+"))).to_be_visible()
    expect(explorer.page.get_by_title("collision with a disc").first).to_be_visible()
    expect(explorer.page.get_by_role("cell", name=re.compile(r"^collision with a disc: \d"))).to_be_visible()
    frame = compute_map(MapSpec(DISC, Plane.X_PX, 0.19, (112, 112), t_max=100.0))
    collided = np.argwhere(frame.fate == 3)
    row, column = collided[np.argmin(np.hypot(*(collided - 56).T))]
    explorer.hover("basins", float(frame.x[column]), float(frame.ordinate[row]))
    expect(explorer.page.locator(".bk-Tooltip").get_by_text("collides with a disc")).to_be_visible()
