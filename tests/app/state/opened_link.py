"""Open a link as the page does, without a page."""

from __future__ import annotations

from collections.abc import Mapping

from app.state.permalink import fit_to_system, linked_view, read_link, refused_link, without_system
from app.state.system_review import review_for_page
from app.state.view_state import ViewState


def open_link(parameters: Mapping[str, str]) -> tuple[ViewState, list[str]]:
    """Return the view of a link once its system is reviewed, and the messages about the link."""
    values, problems = read_link(parameters)
    try:
        reviewed = review_for_page(linked_view(values).system)
        problem = reviewed.problem
    except ValueError as error:
        problem = str(error)
    if problem is not None:
        return ViewState(**without_system(values)), [*problems, refused_link(problem)]
    fitting, more = fit_to_system(values, reviewed)
    state = ViewState()
    state.show(reviewed, **fitting)
    return state, [*problems, *more]
