"""What a layer over the pictures of a map is: an analysis, and how its result is shown.

A layer is one entry, a module of this package that `plots.layers.table` lists. Switches, legends, texts of pixels, progress,
figures, files, links and the options of the command line follow from it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from engine import EscapeMap, MapSpec
from engine.jobs.job import Job
from plots.layers.picture import Picture
from plots.pictures.palette import PALETTES, Entry, Palette

Settings = Mapping[str, Any]
"""Values of the settings of layers by their names; a setting that is left out has its default."""


@dataclass(frozen=True)
class Code:
    """A code of a result in words and colours.

    Attributes
    ----------
    code
        The code.
    label
        In legends.
    sentence
        At the mouse; empty for none.
    colours
        One for each of `PALETTES`, or one for all.
    """

    code: IntEnum
    label: str
    sentence: str
    colours: tuple[str, ...]

    def entry(self, palette: Palette) -> Entry:
        """The entry of a legend."""
        place = list(PALETTES.values()).index(palette)
        return Entry(self.label, self.colours[place % len(self.colours)])


def occurring_entries(codes: Sequence[Code], values: np.ndarray, palette: Palette) -> list[Entry]:
    """The entries of the codes among values of any shape."""
    return [code.entry(palette) for code in codes if np.any(values == code.code)]


@dataclass(frozen=True)
class Setting:
    """A choice of how a layer is computed or drawn.

    Attributes
    ----------
    name
        In links and on the command line.
    title
        Label of the choice on the page, for screen readers.
    word
        Before the first choice.
    choices
        Values by their names in links.
    default
        One of the values.
    help
        Of the option of the command line; empty for a setting of the page only.
    """

    name: str
    title: str
    word: str
    choices: Mapping[str, Any]
    default: Any
    help: str = ""

    def value_in(self, settings: Settings) -> Any:
        """Its value among those of all settings."""
        return settings.get(self.name, self.default)


@dataclass(frozen=True)
class Count:
    """The whole number that switches a layer on at the command line; 0 is off.

    Attributes
    ----------
    metavar
        What is counted.
    most
        Largest number.
    """

    metavar: str
    most: int


@dataclass(frozen=True)
class Pixels:
    """How a result becomes pixel codes.

    Attributes
    ----------
    column
        Name of the column of codes.
    codes
        (rows, columns) uint8 codes of a result on its map, or without one.
    colours
        Of the codes of a result that is drawn alone.
    entries
        Legend of a result that is drawn alone.
    sentences
        Of the codes at the mouse, empty for none.
    own_sentences
        Those of a result, if they depend on it.
    values
        (rows, columns) float32 numbers of a result, which its codes stand for; None without any.
    value_name
        What the numbers are, at the mouse.
    first_codes
        (rows, columns) codes of an image of `EscapeMap.thinned` before there is a result; None without any.
    """

    column: str
    codes: Callable[[Any, EscapeMap | None], np.ndarray]
    colours: Callable[[Palette], Sequence[str]]
    entries: Callable[[Any, Palette], Sequence[Entry]]
    sentences: Sequence[str] = ()
    own_sentences: Callable[[Any], Sequence[str]] | None = None
    values: Callable[[Any], np.ndarray] | None = None
    value_name: str = ""
    first_codes: Callable[[Mapping[str, np.ndarray]], np.ndarray] | None = None

    @property
    def value_column(self) -> str:
        """Name of the column of numbers."""
        return f"{self.column}_value"

    @property
    def word_column(self) -> str:
        """Name of the column of sentences that depend on the result."""
        return f"{self.column}_words"

    @property
    def column_names(self) -> tuple[str, ...]:
        """Names of its columns."""
        numbers = () if self.values is None else (self.value_column,)
        words = () if self.own_sentences is None else (self.word_column,)
        return (self.column, *numbers, *words)

    def columns(self, result: Any, frame: EscapeMap | None) -> dict[str, list[Any]]:
        """The columns of a result on its map, or without one."""
        numbers: dict[str, list[Any]] = {} if self.values is None else {self.value_column: [self.values(result)]}
        words = {} if self.own_sentences is None else {self.word_column: [list(self.own_sentences(result))]}
        return {self.column: [self.codes(result, frame)], **numbers, **words}


@dataclass(frozen=True, eq=False)
class Stroke:
    """Lines of one colour, and how they are drawn.

    Attributes
    ----------
    channel
        Exit channel, from 1, whose colour they have.
    lines
        (n, 2) points of each line in the plane.
    width, halo_width
        Of the line, and of the light line below it, in pixels; 0 for none below it.
    alpha
        Opacity of the line, 0 to 1.
    """

    channel: int
    lines: tuple[np.ndarray, ...]
    width: float
    halo_width: float
    alpha: float


@dataclass(frozen=True)
class Over:
    """What a layer draws over other pictures.

    Attributes
    ----------
    pictures
        Names of the pictures.
    legend
        Entries of a result.
    pixel_colours
        Of the codes of its pixels; None if no pixels are drawn. The first code stands for pixels that are not known.
    strokes
        Curves of a result, from back to front; None if no curves are drawn.
    """

    pictures: tuple[str, ...]
    legend: Callable[[Any, Palette], Sequence[Entry]]
    pixel_colours: Sequence[str] | None = None
    strokes: Callable[[Any], Sequence[Stroke]] | None = None


def own_spec(result: Any) -> MapSpec:
    """The map of a result that has a value for each of its pixels."""
    spec: MapSpec = result.spec
    return spec


def always_allowed(spec: MapSpec) -> str:
    """Refuse no map."""
    return ""


def unchanged(result: Any, settings: Settings) -> Any:
    """Show the whole result."""
    return result


def never(frame: EscapeMap) -> bool:
    """Say no of every map."""
    return False


@dataclass(frozen=True, kw_only=True)
class Layer:
    """A layer over the pictures of a map.

    Attributes
    ----------
    name
        In links, and of its option on the command line.
    title
        Label of its switch.
    help
        Of its option.
    stage
        What the progress bar of the command line says.
    result
        Class of its result, which describes itself in a sentence, ``describe()``, and may be incomplete.
    job
        What computes the result of a map; the settings also have the number of the option under the name of the layer.
        ValueError for a setting that is out of range.
    refusal
        Why a map cannot have the layer; empty if it can.
    count
        If its option is a number.
    settings
        Its choices.
    select
        The part of a result that is drawn.
    spec_of
        The map over which a result is drawn alone.
    pixels
        Its pixel codes; None without any.
    picture
        Its own picture, which shows its pixel codes; None without one.
    over
        What it draws over other pictures; None for nothing.
    variables
        Variables of its dataset that the file of a map contains.
    has_table
        Whether its columns are a file of their own.
    is_empty
        Whether its picture shows nothing of a map.
    is_offered
        Whether the page offers it for a map.
    """

    name: str
    title: str
    help: str
    stage: str
    result: type
    job: Callable[[MapSpec, Settings], Job[Any]]
    refusal: Callable[[MapSpec], str] = always_allowed
    count: Count | None = None
    settings: tuple[Setting, ...] = ()
    select: Callable[[Any, Settings], Any] = unchanged
    spec_of: Callable[[Any], MapSpec] = own_spec
    pixels: Pixels | None = None
    picture: Picture | None = None
    over: Over | None = None
    variables: tuple[str, ...] = ()
    has_table: bool = False
    is_empty: Callable[[EscapeMap], bool] = never
    is_offered: Callable[[EscapeMap], bool] = never

    def over_picture(self, picture: str) -> Over | None:
        """What it draws over a picture; None for nothing."""
        return self.over if self.over is not None and picture in self.over.pictures else None
