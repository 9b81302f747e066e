"""Files for the browser's download folder."""

from __future__ import annotations

from panel.custom import JSComponent

_SAVE = """
export function render({model, el}) {
  el.setAttribute("aria-hidden", "true")
  model.on("msg:custom", ({name, content}) => {
    const address = URL.createObjectURL(new Blob([content]))
    const link = Object.assign(document.createElement("a"), {href: address, download: name})
    document.body.append(link)
    link.click()
    link.remove()
    setTimeout(() => URL.revokeObjectURL(address), 60000)
  })
}
"""


# Bokeh does not register classes whose name starts with an underscore in the browser.
class FileSaver(JSComponent):
    """Takes no room; must be on the page."""

    _esm = _SAVE

    def __init__(self) -> None:
        super().__init__(width=0, height=0, margin=0, styles={"position": "absolute"})

    def save(self, name: str, content: bytes) -> None:
        """Have the browser save a file."""
        self._send_msg({"name": name, "content": content})
