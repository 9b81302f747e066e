"""What all figures share: their type, axes, keys, and how they become files that are the same bytes each time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from importlib import metadata
from io import BytesIO
from typing import Any, Literal

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator, NullFormatter

from app.rendering.palette import LIGHT, PATCH_EDGE, Entry
from engine import Plane

RESOLUTION = 180
"""Pixels per inch of the PNG files."""

# Comes with matplotlib and holds every sign that we print.
_FAMILY, _MATHS = "STIXGeneral", "stix"
_LETTER, _SMALL = 12.0, 10.5
_FRAME = 0.7
_MOST_TICKS = 5
# Around panels, in inches.
_GAP = 0.07

LIMIT: dict[str, Any] = {"color": LIGHT.limiting_curve, "linewidth": 0.9}
EXIT: dict[str, Any] = {"linestyle": (0, (2.0, 1.5))}
"""How the curves that limit a map are drawn, and how its exits differ from them."""

Corner = Literal["upper left", "upper right", "lower left", "lower right", "center right"]
"""Where in a panel its key stands."""

ORDINATES = {Plane.X_Y: "$y$", Plane.X_PX: r"$\dot{x}$", Plane.X_H: "$h$"}
"""What stands on the upright axis of each plane, as in the paper."""

PLANES = {Plane.X_Y: "$(x, y)$", Plane.X_PX: r"$(x, \dot{x})$", Plane.X_H: "$(x, h)$"}
"""Each plane's name on paper."""


def new_figure(width: float, height: float, title: str, *, equal: bool = False) -> Figure:
    """An empty figure of so many inches with a title; for panels with `equal` scales on both axes, or others."""
    figure = Figure(figsize=(width, height), layout=ConstrainedLayoutEngine(h_pad=_GAP, w_pad=_GAP, compress=equal))
    figure.suptitle(title, fontsize=_LETTER + 2.0, color=LIGHT.text)
    return figure


def label_axes(axes: Axes, across: str, up: str) -> None:
    """Name both axes; none where they are empty."""
    axes.set_xlabel(across, fontsize=_LETTER)
    axes.set_ylabel(up, fontsize=_LETTER)


def tidy_axes(axes: Axes) -> None:
    """Frame and ticks of our taste, few of them."""
    axes.tick_params(direction="out", labelsize=_SMALL, width=_FRAME, length=3.0, which="major")
    axes.tick_params(direction="out", width=0.6 * _FRAME, length=1.8, which="minor")
    for spine in axes.spines.values():
        spine.set_linewidth(_FRAME)
    for axis, scale in ((axes.xaxis, axes.get_xscale()), (axes.yaxis, axes.get_yscale())):
        if scale == "linear":
            axis.set_major_locator(MaxNLocator(_MOST_TICKS, steps=[1, 2, 5, 10]))
        if scale == "log":
            axis.set_minor_formatter(NullFormatter())


def name_panel(axes: Axes, words: str) -> None:
    """What a panel shows, over its left end."""
    axes.set_title(words, loc="left", fontsize=_LETTER, color=LIGHT.text, pad=4.0)


def name_panels(panels: Iterable[Axes], words: Sequence[str]) -> None:
    """(a), (b), … with what each one shows."""
    for letter, axes, word in zip("abcdefghi", panels, words, strict=False):
        name_panel(axes, f"({letter}) {word}")


def patches(entries: Iterable[Entry]) -> list[Artist]:
    """The key's patch of each colour."""
    return [Patch(facecolor=entry.colour, edgecolor=PATCH_EDGE, linewidth=0.5, label=entry.label) for entry in entries]


def limiting_lines(plane: Plane) -> list[Artist]:
    """The key's lines for the zero-velocity curve and, on (x, y), for the Lyapunov orbits."""
    lines: list[Artist] = [Line2D([], [], label="zero-velocity curve", **LIMIT)]
    return [*lines, Line2D([], [], label="Lyapunov orbits", **LIMIT, **EXIT)] if plane is Plane.X_Y else lines


def add_key(figure: Figure, handles: Sequence[Artist]) -> None:
    """One key for the whole figure, under all panels."""
    legend = figure.legend(
        handles=list(handles), loc="outside lower center", ncols=len(handles), frameon=False, fontsize=_LETTER - 1.0,
        handlelength=1.4, handleheight=0.9, columnspacing=1.3,
    )  # fmt: skip
    _ink(legend)


def add_panel_key(axes: Axes, place: Corner, columns: int = 1) -> None:
    """A key inside a panel."""
    legend = axes.legend(
        loc=place, ncols=columns, fontsize=_SMALL, framealpha=0.85, edgecolor="none",
        handlelength=1.7, labelspacing=0.3, columnspacing=1.2, borderaxespad=0.4,
    )  # fmt: skip
    _ink(legend)


def _ink(legend: Legend) -> None:
    for text in legend.get_texts():
        text.set_color(LIGHT.text)


def print_figure(figure: Figure, ending: str, about: Mapping[str, str]) -> bytes:
    """The file of a figure.

    Parameters
    ----------
    figure
        Drawn.
    ending
        ``png`` or ``pdf``.
    about
        What the file says of itself: Title, Subject, Keywords.

    Returns
    -------
    Its bytes: the same figure gives the same ones, as no date is among them.
    """
    _set_type(figure)
    maker = f"escape-explorer {metadata.version('escape-explorer')}"
    described: dict[str, str | datetime | None]
    if ending == "pdf":
        described = {**about, "Creator": maker, "Producer": maker, "CreationDate": None}
    else:
        described = {"Title": about["Title"], "Description": about["Subject"], "Comment": about["Keywords"], "Software": maker}
    file = BytesIO()
    figure.savefig(file, format=ending, dpi=RESOLUTION, metadata=described)
    # Everything has its place now, also in the next file.
    figure.set_layout_engine("none")
    return file.getvalue()


def _set_type(figure: Figure) -> None:
    """One family for words and formulas: set on each text, as matplotlib's settings belong to the whole process."""
    for axes in figure.axes:
        axes.tick_params(labelfontfamily=_FAMILY, which="both")
    for text in figure.findobj(Text):
        text.set_fontfamily(_FAMILY)
        text.set_math_fontfamily(_MATHS)
