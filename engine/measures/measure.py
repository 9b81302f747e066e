"""The class of the entries of the table of measures: name, computation, numbers with their errors, and texts of a measure."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from engine.measures.measured_map import MeasuredMap, SweepPoint

Variables = Mapping[str, Any]
"""Variables of a dataset by name, in the form of xarray: dimensions, values and attributes."""


class Bars(StrEnum):
    """Meaning of the error bars of a number. The value of each member is its name in texts."""

    NONE = ""
    INTERVAL = "95 % interval"
    STANDARD_ERROR = "standard error"
    GRID_ERROR = "error of the resolution"


LOW_TEMPLATE = "lower end of the 95 % interval of the {}"
"""Template for the description of the lower end of an interval; the description of its number fills the gap."""

HIGH_TEMPLATE = "upper end of the 95 % interval of the {}"
"""Template for the description of the upper end of an interval; the description of its number fills the gap."""

# Suffixes of the names of the variables of a number, each with the template of the description of its variable.
_SUFFIXES: Mapping[Bars, Mapping[str, str]] = {
    Bars.NONE: {"": "{}"},
    Bars.INTERVAL: {"": "{}", "_low": LOW_TEMPLATE, "_high": HIGH_TEMPLATE},
    Bars.STANDARD_ERROR: {"": "{}", "_error": "standard error of the {}"},
    Bars.GRID_ERROR: {"": "{}", "_error": "error of the resolution of the {}"},
}


@dataclass(frozen=True)
class Quantity[Found]:
    """A number of a measure, dimensionless or in units of the axes.

    Attributes
    ----------
    name
        Name in files, tables and CSV.
    description
        Description of the number, without an article.
    read
        A function that returns the number from a result: alone, with its error, or with the ends of its interval.
    bars
        Meaning of the error bars.
    label
        Label in the legend of its curve; empty for a number without a curve.
    """

    name: str
    description: str
    read: Callable[[Found], float | tuple[float, ...]]
    bars: Bars = Bars.NONE
    label: str = ""

    def variables(self, result: Found | None) -> Variables:
        """Return the number and its errors as variables of a dataset; NaN if `result` is None."""
        suffixes = _SUFFIXES[self.bars]
        numbers = (math.nan,) * len(suffixes) if result is None else self.read(result)
        values = numbers if isinstance(numbers, tuple) else (numbers,)
        return {
            self.name + suffix: describe_number(value, template.format(self.description))
            for value, (suffix, template) in zip(values, suffixes.items(), strict=True)
        }


def describe_number(value: float, description: str) -> tuple[tuple[()], float, dict[str, str]]:
    """Return a dimensionless number as a variable of a dataset, with its description."""
    return (), value, {"long_name": description, "units": "1"}


@dataclass(frozen=True)
class Curve:
    """The diagram of the numbers of a measure against the energy or a parameter.

    Attributes
    ----------
    axis
        Label of the vertical axis.
    logarithmic
        Whether the vertical axis is logarithmic.
    least_top
        Smallest upper limit of a linear axis, which begins at 0.
    level
        Value and label of a marked horizontal line; None for no line.
    """

    axis: str
    logarithmic: bool = False
    least_top: float = 1e-6
    level: tuple[float, str] | None = None


NO_CURVE = Curve("")
"""The curve of measures that are not drawn."""


@dataclass(frozen=True)
class Measure[Found]:
    """A measure of a map: an entry of the table of measures.

    Attributes
    ----------
    name
        Name in the library, in files, in links and on the command line.
    title
        Title on the page and in figures.
    meaning
        Meaning of the measure in about five words.
    compute
        Returns the result for a measured map; None if the measure is not defined for this map.
    quantities
        Numbers of the measure.
    help
        Explanation of the measure and of its curve, in two to four sentences; empty without a curve.
    curve
        The diagram of these numbers against the energy or a parameter; an empty curve if they are not drawn.
    sentence
        Returns a description of the result; None for a measure without a description.
    slow
        Whether the measure integrates further orbits, and is therefore computed on demand.
    place
        Description of what the measure counts, if these are not the starts in a box; otherwise empty.
    terms
        Terms of the glossary that the measure needs, with their definitions.
    other_variables
        Returns further variables of the dataset, given a point of a sweep and the result; None if there are none.
    """

    name: str
    title: str
    meaning: str
    compute: Callable[[MeasuredMap], Found | None]
    quantities: tuple[Quantity[Found], ...] = ()
    help: str = ""
    curve: Curve = NO_CURVE
    sentence: Callable[[Found], str] | None = None
    slow: bool = False
    place: str = ""
    terms: Mapping[str, str] = field(default_factory=dict)
    other_variables: Callable[[SweepPoint, Found], Variables] | None = None

    @property
    def labels(self) -> Mapping[str, str]:
        """Labels of the curves, by the names of their numbers."""
        return {quantity.name: quantity.label for quantity in self.quantities if quantity.label}

    @property
    def bars(self) -> Bars:
        """Meaning of the error bars of the curves, which is the same for all of them."""
        return next((quantity.bars for quantity in self.quantities if quantity.label), Bars.NONE)

    def variables(self, point: SweepPoint, result: Found | None) -> Variables:
        """Return the variables of the measure in the dataset of a sweep; numbers are NaN if `result` is None."""
        variables = {} if self.other_variables is None or result is None else dict(self.other_variables(point, result))
        for quantity in self.quantities:
            variables |= quantity.variables(result)
        return variables
