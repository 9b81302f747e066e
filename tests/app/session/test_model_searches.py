"""Bokeh searches all models of the page only for actions that add parts to the page, and then once."""

from __future__ import annotations

from collections.abc import Callable
from unittest.mock import patch

import pytest
from bokeh.document.models import DocumentModelManager

from app.session.explorer import Explorer
from tests.app.other_loop import run_on_new_loop
from tests.app.session.opened_page import on_loop, opened_page, tell_ready, wait_for

LINK = {"case": "I", "h": "0.3", "resolution": "112", "t_max": "100"}
"""A link to a map without layers and orbits."""

Action = Callable[[Explorer], object]


def add_start(x: float) -> Action:
    return lambda explorer: explorer.maps.add_start(x, 0.1)


def follow(link: str) -> Action:
    return lambda explorer: explorer.links.navigate(link, 0, 0)


def searches_for(*actions: Action) -> int:
    """Return the number of searches that the last of some actions makes at once."""

    async def run() -> int:
        async with opened_page(LINK) as (explorer, session):
            await tell_ready(session)
            await wait_for(explorer.results, "frame", bool)
            for action in actions[:-1]:
                await on_loop(session, lambda action=action: action(explorer))
            recompute = DocumentModelManager.recompute
            with patch.object(DocumentModelManager, "recompute", autospec=True, side_effect=recompute) as search:
                await on_loop(session, lambda: actions[-1](explorer))
                return search.call_count

    return run_on_new_loop(run)


@pytest.mark.parametrize(
    ("actions", "searches"),
    [
        pytest.param([add_start(0.1)], 1, id="first orbit"),
        pytest.param([add_start(0.1), add_start(0.2)], 0, id="second orbit"),
        pytest.param([follow("?case=I&h=0.31")], 0, id="link to another map"),
        pytest.param([follow("?case=I&h=0.31&trust=yes&analysis=measures")], 1, id="link with a layer and an analysis"),
        pytest.param([lambda explorer: explorer.state.switch_layer("judge", on=True)], 1, id="layer"),
        pytest.param([lambda explorer: explorer.state.switch_layer("trust", on=True)], 0, id="layer without a picture"),
    ],
)
def test_the_page_is_searched_once_when_parts_are_added(actions: list[Action], searches: int) -> None:
    assert searches_for(*actions) == searches
