"""Files that the browser saves in its download folder."""

from __future__ import annotations

from pathlib import Path

from panel.custom import JSComponent


# Bokeh does not register classes whose name starts with an underscore in the browser.
class FileSaver(JSComponent):
    """Sends files to the browser. The component has no size, but must be on the page."""

    _esm = Path(__file__).with_suffix(".js")

    def __init__(self) -> None:
        super().__init__(width=0, height=0, margin=0, styles={"position": "absolute"})

    def save(self, name: str, content: bytes) -> None:
        """Send a file, which the browser saves."""
        self._send_msg({"name": name, "content": content})
