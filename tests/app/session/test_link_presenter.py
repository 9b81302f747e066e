"""A link shows its view, also if the view has much in common with the present view."""

from __future__ import annotations

from typing import Any, cast

import pytest
from bokeh.document import Document

from app.session.link_presenter import LinkPresenter
from app.state.view_state import ViewState
from app.views.components.notice import Notice
from engine import Window
from tests.app.other_loop import run_on_new_loop
from tests.app.session.opened_page import on_loop, opened_page


def test_a_link_to_another_window_keeps_the_box_that_both_views_have() -> None:
    async def follow() -> ViewState:
        view = {"case": "I", "h": "0.3", "window": "-0.3,0.3,-0.3,0.3", "box": "-0.1,0.1,-0.1,0.1"}
        async with opened_page(view) as (explorer, session):
            link = "?case=I&h=0.3&window=-0.2,0.2,-0.2,0.2&box=-0.1,0.1,-0.1,0.1"
            await on_loop(session, lambda: explorer.links.navigate(link, 0, 0))
            return explorer.state

    state = run_on_new_loop(follow)
    assert state.window == Window(-0.2, 0.2, -0.2, 0.2)
    assert state.box == Window(-0.1, 0.1, -0.1, 0.1)


def test_a_comparison_that_is_refused_before_the_page_is_made_is_named_when_the_view_begins() -> None:
    links, notice, unused = LinkPresenter(Document(), {"case": "I"}), Notice(), cast("Any", None)
    links.refuse_comparison("The formula ends too soon.")
    links.connect(unused, unused, unused, notice)
    links.begin(lambda: None)
    assert "Ignored the view in the link with which to compare: The formula ends too soon." in notice.layout().object


@pytest.mark.parametrize("others", [{}, {"h": "high"}])
def test_unknown_parameters_of_a_link_are_named_once(others: dict[str, str]) -> None:
    link = {"case": "I", "potential": "", "<b>": "", **others}
    links, notice, unused = LinkPresenter(Document(), link), Notice(), cast("Any", None)
    links.connect(unused, unused, unused, notice)
    links.begin(lambda: None)
    assert "Ignored potential, ?b?: the parameters of a link are case, V" in notice.layout().object
    notice.clear()
    links.begin(lambda: None)
    assert "potential" not in notice.layout().object
