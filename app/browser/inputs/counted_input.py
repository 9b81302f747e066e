"""Inputs that count their values, so the browser ignores older values from the server."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import Any

import param
from panel.custom import JSComponent


class CountedInput(JSComponent):
    """An input whose browser part uses `CountedValue` in counted_value.js.

    Bokeh's widgets would show each value of the server at once, even over a value that is being typed. Panel would drop a typed
    value while an earlier action that sets another value is waiting.

    Parameters
    ----------
    on_value
        Takes each legal value of the visitor, and whether the value is final, without the session's lock.
    value
        The initial value.
    **options
        Parameters of the component.
    """

    label = param.String()
    disabled = param.Boolean()
    shown = param.Dict(default={}, doc="value, and number of the visitor's values that the server knew when it set the value")

    def __init__(self, on_value: Callable[[Any, bool], None], value: Any, **options: Any) -> None:
        super().__init__(shown={"value": value, "count": 0}, **options)
        self._on_value = on_value
        self.on_msg(lambda event: self._receive(event.data))

    @property
    def value(self) -> Any:
        """The last value that the server has shown or received."""
        return self.shown["value"]

    def show(self, value: Any) -> None:
        """Show a value."""
        self.shown = self.shown | {"value": value}

    def _checked(self, value: Any) -> Any:
        """Return the value in a message; None for an illegal value."""
        raise NotImplementedError

    def _receive(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"value": sent, "count": int(count), "done": bool(done)}:
                value = self._checked(sent)
                # The browser shows the last legal value in place of an illegal value.
                self.shown = {"value": self.value if value is None else value, "count": count}
                if value is not None:
                    self._on_value(value, done)


def finite_number(value: Any) -> float | None:
    """Return a number from a message; None for anything but a finite number."""
    return float(value) if isinstance(value, int | float) and isfinite(value) else None
