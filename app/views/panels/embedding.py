"""A picture in a frame of another page: the code of the frame, and in the frame the link to the whole page."""

from __future__ import annotations

from html import escape
from typing import Any

from app.state.permalink import write_link
from app.state.view_state import ViewState
from app.views.components.texts import TextPane

NOT_ALLOWED = "Embedding is switched off on this server."

# Side of the frame in pixels; pictures are square.
_SIDE = 600


def page_address(request: Any) -> str:
    """The absolute address of the page that a request asks for, without parameters.

    Host and scheme are those of the request, or with ``--use-xheaders`` those that the proxy states.
    """
    return f"{request.protocol}://{request.host}{request.path}"


def embed_code(address: str, state: ViewState) -> str:
    """HTML of a frame with the picture of a view that is shown large, or else with its basins.

    Parameters
    ----------
    address
        Absolute address of the page, without parameters.
    state
        The view.
    """
    source, title = address + write_link(state, embedded=True), f"Escapes: {state.system.title}"
    return (
        f'<iframe src="{escape(source)}" title="{escape(title)}" width="{_SIDE}" height="{_SIDE}" '
        'style="border: 0" loading="lazy"></iframe>'
    )


class OpenLink:
    """The link in an embedded page that opens its view in a tab of its own."""

    def __init__(self) -> None:
        self.pane = TextPane("", margin=0, css_classes=["open-explorer"])

    def show(self, link: str) -> None:
        """Lead to a view; `link` is the result of `app.state.permalink.write_link`."""
        self.pane.object = f'<a href="{escape(link)}" target="_blank" rel="noopener">Open in the explorer</a>'
