"""Inputs whose values arrive with their numbers, so that an older value of the server does not replace a newer one."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import Any

import param
from panel.custom import JSComponent


class CountedInput(JSComponent):
    """An input; `CountedValue` of counted_value.js is its part in the browser.

    Widgets of Bokeh show each value of the server at once, also over one that is being typed; and Panel drops a value that is
    typed while an earlier action, which sets another one, is still to be handled.

    Parameters
    ----------
    on_value
        Called with each legal value that the visitor gives, and whether it is done, without the session's lock.
    value
        The value at first.
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
        """The value that a message means; None if it is not legal."""
        raise NotImplementedError

    def _receive(self, message: Any) -> None:
        # Messages come from a browser: ignore what is not expected.
        match message:
            case {"value": sent, "count": int(count), "done": bool(done)}:
                value = self._checked(sent)
                # The browser shows the last legal value in place of another one.
                self.shown = {"value": self.value if value is None else value, "count": count}
                if value is not None:
                    self._on_value(value, done)


def finite_number(value: Any) -> float | None:
    """A finite number of a message; None for anything else."""
    return float(value) if isinstance(value, int | float) and isfinite(value) else None
