"""Components that make the browser save a file or copy an image."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import param

from app.browser.components.plain_component import PlainComponent
from plots.browser.javascript import component_code


# In the browser, Bokeh does not register classes whose name starts with an underscore.
class FileSaver(PlainComponent):
    """Sends files to the browser, which saves them in its download folder. The component has no size, but must be on the page."""

    _esm = component_code(Path(__file__).with_name("file_saver.js"))

    def __init__(self) -> None:
        super().__init__(width=0, height=0, margin=0, styles={"position": "absolute"})

    def save(self, name: str, content: bytes) -> None:
        """Send a file, which the browser saves."""
        self._send_msg({"name": name, "content": content})


class ImageCopier(PlainComponent):
    """A button that copies an image to the clipboard, which browsers allow only during the click.

    Parameters
    ----------
    on_wanted
        Called after a click, without the session's lock. It must lead to a call of `send`.
    on_copied
        Called with whether the browser has copied the image.
    **options
        Parameters of the component.
    """

    label = param.String(default="Copy image", doc="text of the button")
    disabled = param.Boolean(default=False, doc="whether the button is disabled")

    _esm = Path(__file__).with_name("image_copier.js")

    def __init__(self, on_wanted: Callable[[], None], on_copied: Callable[[bool], None], **options: Any) -> None:
        super().__init__(**options)
        self._on_wanted, self._on_copied = on_wanted, on_copied

    def send(self, image: bytes | None) -> None:
        """Send the image as a PNG file; None if it could not be made."""
        self._send_msg({"image": image})

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"wanted": True}:
                self._on_wanted()
            case {"copied": bool(success)}:
                self._on_copied(success)
