"""WebSockets whose parts of messages leave at once: a message of Bokeh's is a dozen of them.

By default a network sends the first part of a message and keeps the others until the visitor's machine says that the first has
come: a journey there and back, and up to 40 ms more where that machine has nothing else to say (Nagle's algorithm and delayed
acknowledgements, RFC 1122, 4.2.3.2 and 4.2.3.4).
"""

from __future__ import annotations

from panel.io.server import WSHandler


class PromptSocket(WSHandler):
    """Panel's, which waits with nothing."""

    def open(self) -> None:
        """Begin."""
        self.set_nodelay(True)
        super().open()


def use_prompt_sockets(patterns: list[tuple[str, type]]) -> None:
    """Put it in the place of Panel's own.

    Parameters
    ----------
    patterns
        Paths and handlers for each app, before Bokeh builds its web application from them.
    """
    patterns[:] = [(path, PromptSocket if handler is WSHandler else handler) for path, handler in patterns]
