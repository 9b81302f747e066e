"""Inputs that number their values, so that an older value from the server does not replace a newer one."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import Any

import param
from panel.custom import JSComponent


class CountedInput(JSComponent):
    """An input; its part in the browser is `CountedValue` in counted_value.js.

    Widgets of Bokeh show each value of the server at once, even over a value that is being typed. Panel drops a value that is
    typed while an earlier action that sets another value is still waiting.

    Parameters
    ----------
    on_value
        Called with each legal value that the visitor enters, and whether the value is final, without the session's lock.
    value
        The initial value.
    **options
        Parameters of the component.
    """

    label = param.String()
    disabled = param.Boolean()
    shown = param.Dict(default={}, doc="value, and how many of the visitor the server knew of when it set this one")

    def __init__(self, on_value: Callable[[Any, bool], None], value: Any, **options: Any) -> None:
        super().__init__(shown={"value": value, "count": 0}, **options)
        self._on_value = on_value
        self.on_msg(lambda event: self._receive(event.data))

    @property
    def value(self) -> Any:
        """The value in the browser, as far as the server knows."""
        return self.shown["value"]

    def show(self, value: Any) -> None:
        """Show a value."""
        self.shown = self.shown | {"value": value}

    def _checked(self, value: Any) -> Any:
        """Return the value in a message; None if it is not legal."""
        raise NotImplementedError

    def _receive(self, message: Any) -> None:
        # Messages come from a browser: unexpected ones are ignored.
        match message:
            case {"value": sent, "count": int(count), "done": bool(done)}:
                value = self._checked(sent)
                # The browser shows the last legal value in place of an illegal one.
                self.shown = {"value": self.value if value is None else value, "count": count}
                if value is not None:
                    self._on_value(value, done)


def finite_number(value: Any) -> float | None:
    """Return a finite number from a message; None for anything else."""
    return float(value) if isinstance(value, int | float) and isfinite(value) else None
