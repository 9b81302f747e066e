"""Define a layer over the pictures of a map: an analysis, and how its result is shown.

A layer is one entry in a module of this package, listed in `plots.layers.table`. Switches, legends, texts of pixels, progress,
figures, files, links and options of the command line follow from the entry.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from types import MappingProxyType, UnionType
from typing import Any

import numpy as np

from engine import EscapeMap, MapSpec, Result
from engine.jobs.job import Job
from plots.layers.picture import Picture
from plots.pictures.palette import PALETTES, Entry, Palette
from plots.pictures.setting import Setting, Settings

Analyses = Mapping[str, Any]
"""Complete results of layers, by name. Layers that were not requested or are not finished are missing."""

NO_ANALYSES: Analyses = MappingProxyType({})
"""No results."""


@dataclass(frozen=True)
class Code:
    """The label and the colours of a pixel code.

    Attributes
    ----------
    code
        The code.
    label
        Label in legends.
    sentence
        Description in the hover text; empty if there is none.
    colours
        One colour for each of `PALETTES`, or one for all.
    """

    code: IntEnum
    label: str
    sentence: str
    colours: tuple[str, ...]

    def entry(self, palette: Palette) -> Entry:
        """Return the entry of a legend."""
        # The remainder is 0 for a code with one colour, which all palettes share.
        index = [each.name for each in PALETTES.values()].index(palette.name)
        return Entry(self.label, self.colours[index % len(self.colours)])


def occurring_entries(codes: Sequence[Code], values: np.ndarray, palette: Palette) -> list[Entry]:
    """Return the legend entries of the codes that occur among `values`, an array of any shape."""
    return [code.entry(palette) for code in codes if np.any(values == code.code)]


@dataclass(frozen=True)
class Count:
    """The whole number that switches a layer on at the command line; 0 means off.

    Attributes
    ----------
    metavar
        Word in the help for the counted things.
    most
        Largest legal number.
    """

    metavar: str
    most: int


@dataclass(frozen=True)
class Pixels[Found]:
    """How pixel codes are made from a result.

    Attributes
    ----------
    column
        Name of the column of codes in the data source of the pictures.
    codes
        Returns the uint8 codes of a result, of shape (rows, columns). The map is None when the result is drawn alone.
    colours
        Colours of the codes when the result is drawn alone.
    entries
        Legend when the result is drawn alone.
    sentences
        Descriptions of the codes in the hover text; empty for codes without a description.
    own_sentences
        Returns descriptions of the codes for a result; None if descriptions do not depend on the result.
    values
        Returns the float32 values, of shape (rows, columns), behind the codes of a result; None if there are none.
    value_name
        Name of the values in the hover text.
    first_codes
        Returns the codes until there is a result, from the images of `EscapeMap.thinned`; None if there are none until then.
    """

    column: str
    codes: Callable[[Found, EscapeMap | None], np.ndarray]
    colours: Callable[[Palette], Sequence[str]]
    entries: Callable[[Found, Palette], Sequence[Entry]]
    sentences: Sequence[str] = ()
    own_sentences: Callable[[Found], Sequence[str]] | None = None
    values: Callable[[Found], np.ndarray] | None = None
    value_name: str = ""
    first_codes: Callable[[Mapping[str, np.ndarray]], np.ndarray] | None = None

    @property
    def value_column(self) -> str:
        """Name of the column of values."""
        return f"{self.column}_value"

    @property
    def word_column(self) -> str:
        """Name of the column of descriptions that depend on the result."""
        return f"{self.column}_words"

    @property
    def column_names(self) -> tuple[str, ...]:
        """Names of all columns."""
        numbers = () if self.values is None else (self.value_column,)
        words = () if self.own_sentences is None else (self.word_column,)
        return (self.column, *numbers, *words)

    def columns(self, result: Found, frame: EscapeMap | None) -> dict[str, list[Any]]:
        """Return the columns of a result. `frame` is the map of the result, or None as in `codes`."""
        numbers: dict[str, list[Any]] = {} if self.values is None else {self.value_column: [self.values(result)]}
        words = {} if self.own_sentences is None else {self.word_column: [list(self.own_sentences(result))]}
        return {self.column: [self.codes(result, frame)], **numbers, **words}


@dataclass(frozen=True, eq=False)
class Stroke:
    """Lines of one colour, with their widths and opacity.

    Attributes
    ----------
    colour
        Returns the colour of the lines.
    lines
        Points of each line in the plane, of shape (n, 2).
    width, halo_width
        Widths of each line and of the light line behind it, in pixels. A halo width of 0 means no light line.
    alpha
        Opacity of the line, 0 to 1.
    """

    colour: Callable[[Palette], str]
    lines: tuple[np.ndarray, ...]
    width: float
    halo_width: float
    alpha: float


@dataclass(frozen=True)
class Over[Found]:
    """What a layer draws over other pictures.

    Attributes
    ----------
    pictures
        Names of the pictures.
    legend
        Legend entries of a result.
    pixel_colours
        Colours of the pixel codes; None if no pixels are drawn. The first code stands for pixels that are not known.
    strokes
        Curves of a result, from back to front; None if no curves are drawn.
    """

    pictures: tuple[str, ...]
    legend: Callable[[Found, Palette], Sequence[Entry]]
    pixel_colours: Sequence[str] | None = None
    strokes: Callable[[Found], Sequence[Stroke]] | None = None


def _spec_of(result: Any) -> MapSpec:
    """Return the request of a result that has it as an attribute."""
    return result.spec


@dataclass(frozen=True, kw_only=True)
class Layer[Found: Result]:
    """A layer over the pictures of a map.

    Attributes
    ----------
    name
        Name in links, and of the option on the command line.
    title
        Label of the switch.
    help
        Help of the option.
    stage
        Text of the progress bar of the command line.
    result
        Class of the result, or a union of classes. Its method ``describe()`` returns a sentence, even for an incomplete result.
    job
        Returns the job that computes the result of a map, or raises ValueError if a setting is out of range. The settings contain
        the number of `count` under the name of the layer.
    refusal
        Reason why the layer cannot be computed for a map; empty if it can.
    count
        The number that switches the layer on; None if the option is a flag.
    settings
        Settings of how the layer is computed or drawn.
    select
        Returns the part of a result that is drawn; by default the whole result.
    spec_of
        Returns the request of the map on which a result is drawn alone; by default its attribute `spec`.
    pixels
        Pixel codes of the layer; None if it has none.
    picture
        The layer's own picture, which shows its pixel codes; None if it has none.
    over
        What the layer draws over other pictures; None if it draws nothing.
    variables
        Variables of the result's dataset that are written to the file of a map.
    has_table
        Whether the variables are also written to a file of their own.
    is_empty
        Whether the picture would show nothing for a map.
    is_offered
        Whether the page suggests the layer below a map.
    """

    name: str
    title: str
    help: str
    stage: str
    result: type[Found] | UnionType
    job: Callable[[MapSpec, Settings], Job[Found]]
    refusal: Callable[[MapSpec], str] = lambda spec: ""
    count: Count | None = None
    settings: tuple[Setting, ...] = ()
    select: Callable[[Found, Settings], Found] = lambda result, settings: result
    spec_of: Callable[[Found], MapSpec] = _spec_of
    pixels: Pixels[Found] | None = None
    picture: Picture | None = None
    over: Over[Found] | None = None
    variables: tuple[str, ...] = ()
    has_table: bool = False
    is_empty: Callable[[EscapeMap], bool] = lambda frame: False
    is_offered: Callable[[EscapeMap], bool] = lambda frame: False

    def over_picture(self, picture: str) -> Over[Found] | None:
        """Return what the layer draws over a picture; None if it draws nothing."""
        return self.over if self.over is not None and picture in self.over.pictures else None
