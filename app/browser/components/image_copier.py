"""A button that copies an image to the clipboard, which browsers allow only during the click."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import param
from panel.custom import JSComponent


class ImageCopier(JSComponent):
    """A button that copies an image.

    Parameters
    ----------
    on_wanted
        Handles a click, without the session's lock, and must lead to a call of `send`.
    on_copied
        Takes whether the browser has copied the image.
    **options
        Parameters of the component.
    """

    label = param.String(default="Copy image")
    disabled = param.Boolean(default=False)

    _esm = Path(__file__).with_suffix(".js")

    def __init__(self, on_wanted: Callable[[], None], on_copied: Callable[[bool], None], **options: Any) -> None:
        super().__init__(**options)
        self._on_wanted, self._on_copied = on_wanted, on_copied
        self.on_msg(lambda event: self._receive(event.data))

    def send(self, image: bytes | None) -> None:
        """Send the image as a PNG file; None if it could not be made."""
        self._send_msg({"image": image})

    def _receive(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"wanted": True}:
                self._on_wanted()
            case {"copied": bool(success)}:
                self._on_copied(success)
