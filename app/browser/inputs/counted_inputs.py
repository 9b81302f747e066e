"""Inputs that number the values they send, so that the browser can ignore older values from the server."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple

import param

from app.browser.components.plain_component import PlainComponent
from app.job_clients.parameter_shares import SliderShares
from plots.browser.javascript import component_code

LONGEST_TYPED = 4000
"""Largest length of a typed text, in characters. The box cuts longer texts silently, so this is larger than the limit for
formulas, whose message is then shown."""

_NO_STRIP = asdict(SliderShares("", "", ()))


def _code(name: str) -> str:
    """Return the JavaScript of an input."""
    return component_code(Path(__file__).with_name(f"{name}.js"))


class CountedInput(PlainComponent):
    """An input whose browser part uses `CountedValue` in counted_value.js.

    Bokeh's widgets would show each value from the server at once, even over a value that is being typed. While an earlier action
    that sets another value is pending, Panel would discard a typed value.

    Parameters
    ----------
    on_value
        Called with each legal value that the visitor enters and with whether the value is final. The call does not hold the
        session's lock.
    value
        The initial value.
    **options
        Parameters of the component.
    """

    label = param.String(doc="text beside the input")
    disabled = param.Boolean(doc="whether the input accepts no values")
    shown = param.Dict(
        default={}, doc="shown value, and number of values that the server had received from the browser when it set this value"
    )

    def __init__(self, on_value: Callable[[Any, bool], None], value: Any, **options: Any) -> None:
        super().__init__(shown={"value": value, "count": 0}, **options)
        self._on_value = on_value

    @property
    def value(self) -> Any:
        """The last value that the server has shown or received."""
        return self.shown["value"]

    def show(self, value: Any) -> None:
        """Show a value, unless the browser has a newer one."""
        self.shown = self.shown | {"value": value}

    def _legal_value(self, value: Any) -> Any:
        """Return the value from a message, within the limits of the input; None if it is illegal."""
        raise NotImplementedError

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"value": sent_value, "count": int(count), "done": bool(is_final)}:
                value = self._legal_value(sent_value)
                # The browser shows the last legal value in place of an illegal value.
                self.shown = {"value": self.value if value is None else value, "count": count}
                if value is not None:
                    self._on_value(value, is_final)


class NumberBox(CountedInput):
    """A labelled box for a number.

    Parameters
    ----------
    on_number
        Called with each final number, without the session's lock.
    number
        The initial number.
    **options
        Parameters of the component.
    """

    step = param.Number(default=0.1, doc="step of the arrow keys and buttons")

    _esm = _code("number_box")

    def __init__(self, on_number: Callable[[float], None], number: float, **options: Any) -> None:
        super().__init__(lambda value, is_final: on_number(value), number, **options)

    def _legal_value(self, value: Any) -> float | None:
        return _finite_number(value)


class EnergyBox(PlainComponent):
    """A box for the energy of the page's store."""

    label = param.String(default="Exact h", doc="text beside the box")
    disabled = param.Boolean(doc="whether the box accepts no values")
    step = param.Number(default=0.1, doc="step of the arrow keys and buttons")

    _esm = _code("number_box")


class EnergySlider(PlainComponent):
    """A slider for the energy of the page's store. For an energy beyond an end of the slider, the thumb is at that end.

    The engine in the browser paints the shares of the outcomes at all energies of the slider behind the thumb.
    """

    label = param.String(default="Energy h", doc="text beside the slider")
    disabled = param.Boolean(doc="whether the slider cannot be moved")
    note = param.String(doc="text in place of the label and the number; empty for none")
    low = param.Number(default=0.0, doc="energy at the left end")
    high = param.Number(default=1.0, doc="energy at the right end")
    decimals = param.Integer(default=3, doc="number of decimals of the energies that can be chosen")
    openings = param.List(doc="energies at which exits open, marked if they are on the slider")
    marked = param.List(doc="other marked energies")
    legend = param.String(doc="text about the openings; empty for none")

    _esm = _code("energy_slider")


class SliderParameter(NamedTuple):
    """A parameter that a slider sets.

    Attributes
    ----------
    name
        The name.
    label
        Text beside the slider.
    low, high
        Numbers at the ends of the slider.
    lowest, highest
        Smallest and largest legal number of the box.
    """

    name: str
    label: str
    low: float
    high: float
    lowest: float
    highest: float


class ParameterSliders(PlainComponent):
    """Sliders of parameters, each with a box for its number.

    A number is final when the slider is released, when the slider or the box loses focus, or when Enter is pressed in the box.
    For a number beyond an end of the slider, the thumb is at that end. One component shows all sliders, because each component
    that is added to the page takes about 10 ms of the event loop.

    Parameters
    ----------
    on_number
        Called with the name of a parameter, each legal number that the visitor enters, and whether the number is final. The call
        does not hold the session's lock.
    on_rest
        Called when the view has been at rest for a while, likewise.
    **options
        Parameters of the component.
    """

    rows = param.List(doc="fields of `SliderParameter` with the shown number and the count of numbers received before, by name")
    step = param.Number(default=0.01, doc="step of the sliders and of the boxes")
    strip = param.Dict(default=_NO_STRIP | {"count": 0}, doc="fields of `SliderShares`, and the number of views before")

    _esm = _code("parameter_sliders")

    def __init__(
        self, on_number: Callable[[str, float, bool], None], on_rest: Callable[[], None] = lambda: None, **options: Any
    ) -> None:
        super().__init__(**options)
        self._on_number, self._on_rest = on_number, on_rest
        self._moved = ""
        # Numbers received from the browser so far. A slider that is shown again goes on counting.
        self._counts: dict[str, int] = {}

    def show(self, parameters: Mapping[SliderParameter, float]) -> None:
        """Show sliders of these parameters, in order, with these numbers, unless the browser has newer numbers."""
        self.rows = [
            parameter._asdict() | {"value": number, "count": self._counts.get(parameter.name, 0)}
            for parameter, number in parameters.items()
        ]

    @property
    def moved(self) -> SliderParameter | None:
        """The parameter whose slider was moved last, or the first parameter; None without sliders."""
        row = next((row for row in self.rows if row["name"] == self._moved), next(iter(self.rows), None))
        return None if row is None else SliderParameter(*(row[field] for field in SliderParameter._fields))

    def show_shares(self, shares: SliderShares) -> None:
        """Show the shares of the outcomes on the slider of a parameter."""
        self.strip = asdict(shares) | {"count": self.strip["count"]}

    def clear_shares(self) -> None:
        """Show no shares until the new view has been at rest for a while."""
        self.strip = _NO_STRIP | {"count": self.strip["count"] + 1}

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages, and those of sliders that are no longer shown, are ignored.
        match message:
            case {"rest": int(count)} if count == self.strip["count"]:
                self._on_rest()
            case {"name": str(name), "value": sent_value, "count": int(count), "done": bool(is_final)}:
                row = next((row for row in self.rows if row["name"] == name), None)
                if row is not None:
                    self._take(row, _finite_number(sent_value), count, is_final=is_final)

    def _take(self, row: dict[str, Any], number: float | None, count: int, *, is_final: bool) -> None:
        """Take a number of a slider. The browser shows the last legal number in place of an illegal number."""
        is_legal = number is not None and row["lowest"] <= number <= row["highest"]
        self._counts[row["name"]] = count
        changed_row = row | {"value": number if is_legal else row["value"], "count": count}
        self.rows = [changed_row if each is row else each for each in self.rows]
        if number is not None and is_legal:
            self._moved = row["name"]
            self._on_number(row["name"], number, is_final)


class FormulaBox(CountedInput):
    """A box for a formula. The text is final when Enter is pressed or the box loses focus."""

    placeholder = param.String(doc="text in an empty box")
    longest = param.Integer(default=LONGEST_TYPED, doc="largest length of the text, in characters")

    _esm = _code("formula_box")

    def _legal_value(self, value: Any) -> str | None:
        return value if isinstance(value, str) and len(value) <= self.longest else None


def _finite_number(value: Any) -> float | None:
    """Return a number from a message; None for anything but a finite number."""
    return float(value) if isinstance(value, int | float) and isfinite(value) else None
