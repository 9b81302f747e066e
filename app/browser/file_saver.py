"""Files for the browser's download folder."""

from __future__ import annotations

from panel.custom import JSComponent

from app.browser.callbacks import module_path


# Bokeh does not register classes whose name starts with an underscore in the browser.
class FileSaver(JSComponent):
    """A component without size that must be on the page."""

    _esm = module_path("file_saver.js")

    def __init__(self) -> None:
        super().__init__(width=0, height=0, margin=0, styles={"position": "absolute"})

    def save(self, name: str, content: bytes) -> None:
        """Have the browser save a file."""
        self._send_msg({"name": name, "content": content})
