"""A picture in a frame of another page: the HTML of the frame, and the link from the frame to the whole page."""

from __future__ import annotations

from html import escape
from typing import Any

from bokeh.document import Document

from app.state.permalink import write_link
from app.state.view_state import ViewState
from app.views.components.texts import TextPane

NOT_ALLOWED = "Frames in other pages are switched off. The operator of the server allows them with the setting FRAME_ANCESTORS."

# Width and height of the frame, in pixels: pictures are square.
_SIDE = 600


def page_host(document: Document) -> str:
    """Return the host of the page of a document, without port; empty for a page without a request."""
    return str(getattr(getattr(document.session_context, "request", None), "host_name", ""))


def page_address(request: Any) -> str:
    """Return the absolute address of the page of a request, without parameters.

    Host and scheme come from the request, or with ``--use-xheaders`` from the proxy.
    """
    return f"{request.protocol}://{request.host}{request.path}"


def embed_code(address: str, state: ViewState) -> str:
    """Return HTML of a frame with one picture of a view: the picture shown large, or else the basins.

    Parameters
    ----------
    address
        Absolute address of the page, without parameters.
    state
        The view state.
    """
    source = address + write_link(state, embedded=True)
    title = f"Escapes: {state.system.title}"
    return (
        f'<iframe src="{escape(source)}" title="{escape(title)}" width="{_SIDE}" height="{_SIDE}" '
        'style="border: 0" loading="lazy"></iframe>'
    )


class OpenLink:
    """The link with which an embedded page opens its view in a new tab."""

    def __init__(self) -> None:
        self.pane = TextPane("", margin=0, css_classes=["open-explorer"])

    def show(self, link: str) -> None:
        """Set the view that opens, given the result of `app.state.permalink.write_link`."""
        self.pane.object = f'<a href="{escape(link)}" target="_blank" rel="noopener">Open in the explorer</a>'
