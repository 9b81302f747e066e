"""Files for the browser's download folder."""

from __future__ import annotations

from pathlib import Path

from panel.custom import JSComponent


# Bokeh does not register classes whose name starts with an underscore in the browser.
class FileSaver(JSComponent):
    """A component without size that must be on the page."""

    _esm = Path(__file__).with_suffix(".js")

    def __init__(self) -> None:
        super().__init__(width=0, height=0, margin=0, styles={"position": "absolute"})

    def save(self, name: str, content: bytes) -> None:
        """Have the browser save a file."""
        self._send_msg({"name": name, "content": content})
