"""Shared style of all figures: text sizes, axes, panel titles, legends and reproducible files.

Figures use Matplotlib's object-oriented API. Matplotlib is not thread-safe: threads draw and save under `RENDER_LOCK`.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from decimal import Decimal
from importlib import metadata
from io import BytesIO
from typing import Any, Literal, NamedTuple

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.legend import Legend
from matplotlib.patches import Patch
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator, NullFormatter
from matplotlib.transforms import Bbox

from plots.palette import LIGHT, PATCH_EDGE, Entry

RENDER_LOCK = threading.Lock()
"""Held by a thread while it draws and saves a figure."""

RESOLUTION = 180
"""Pixels per inch of the PNG files of the reproduction."""

LETTER, SMALL = 12.0, 10.5
"""Font sizes of labels and of tick labels, in points."""

# The STIX fonts are part of Matplotlib; they have Greek letters, fractions and mathematical symbols.
_FAMILY, _MATHS = "STIXGeneral", "stix"
_FRAME = 0.7
_MOST_TICKS = 5
# Padding around panels, in inches.
_GAP = 0.07
# Around a cropped figure, in pixels.
_MARGIN = 8
_FEWEST_TICKS = 3
# Smaller tick steps than 10 to this power are labelled as distances from the middle tick: plain labels would overlap.
_FINEST_PLAIN_STEP = -4

Corner = Literal["upper left", "upper right", "lower left", "lower right", "center right"]
"""Position of a legend in its panel."""

POINTS_PER_INCH = 72.0


class Axis(NamedTuple):
    """Name of an axis, and for each tick its position, 0 to 1 along the axis, and its label."""

    name: str
    ticks: list[tuple[float, str]]


def label_axis(name: str, low: float, high: float) -> Axis:
    """Ticks at multiples of 1, 2 or 5 · 10^k between two numbers, three to eight of them, with exact labels.

    If they are less than 1e-4 apart, the labels are distances from the middle tick, which the axis name then states.
    """
    most = (high - low) / _FEWEST_TICKS
    exponent = math.floor(math.log10(most))
    step = Decimal(next((m for m in (5, 2) if m * 10.0**exponent <= most), 1)).scaleb(exponent)
    numbers = range(math.ceil(Decimal(low) / step), math.floor(Decimal(high) / step) + 1)
    values = [number * step for number in numbers]
    labels = [f"{value:f}" for value in values]
    if exponent < _FINEST_PLAIN_STEP:
        middle = values[len(values) // 2]
        labels = [f"{(value - middle).scaleb(-exponent):f}" for value in values]
        offset = f"({name} {'−' if middle > 0 else '+'} {abs(middle):f})" if middle else name
        name = f"{offset} / 1e{exponent}"
    positions = [float(value - Decimal(low)) / (high - low) for value in values]
    return Axis(name, [(position, label.replace("-", "−")) for position, label in zip(positions, labels, strict=True)])


def new_figure(width: float, height: float, title: str, *, equal: bool = False) -> Figure:
    """Empty figure with a title, in inches; `equal` packs panels that have equal scales on both axes."""
    figure = Figure(figsize=(width, height), layout=ConstrainedLayoutEngine(h_pad=_GAP, w_pad=_GAP, compress=equal))
    figure.suptitle(title, fontsize=LETTER + 2.0, color=LIGHT.text)
    return figure


def label_axes(axes: Axes, across: str, up: str) -> None:
    """Name both axes."""
    axes.set_xlabel(across, fontsize=LETTER)
    axes.set_ylabel(up, fontsize=LETTER)


def style_axes(axes: Axes, *, grid: bool = False) -> None:
    """Thin frame, short ticks, at most five intervals between ticks on linear axes, and optionally a faint grid."""
    axes.tick_params(direction="out", labelsize=SMALL, width=_FRAME, length=3.0, which="major")
    axes.tick_params(direction="out", width=0.6 * _FRAME, length=1.8, which="minor")
    for spine in axes.spines.values():
        spine.set_linewidth(_FRAME)
    for axis, scale in ((axes.xaxis, axes.get_xscale()), (axes.yaxis, axes.get_yscale())):
        if scale == "log":
            axis.set_minor_formatter(NullFormatter())
        else:
            axis.set_major_locator(MaxNLocator(_MOST_TICKS, steps=[1, 2, 5, 10]))
    if grid:
        axes.grid(alpha=0.25, linewidth=0.5)


def name_panel(axes: Axes, words: str) -> None:
    """Write the title of a panel above its left end."""
    axes.set_title(words, loc="left", fontsize=LETTER, color=LIGHT.text, pad=4.0)


def name_panels(panels: Iterable[Axes], words: Sequence[str]) -> None:
    """Title panels (a), (b), …"""
    for letter, axes, word in zip("abcdefghi", panels, words, strict=False):
        name_panel(axes, f"({letter}) {word}")


def patches(entries: Iterable[Entry]) -> list[Artist]:
    """Legend handles of colours."""
    return [Patch(facecolor=entry.colour, edgecolor=PATCH_EDGE, linewidth=0.5, label=entry.label) for entry in entries]


def add_figure_legend(figure: Figure, handles: Sequence[Artist]) -> None:
    """Add one legend for the whole figure, below all panels."""
    _colour_text(figure.legend(handles=list(handles), loc="outside lower center", ncols=len(handles), **_legend_style()))


def add_legend_below(axes: Axes, handles: Sequence[Artist], offset: float, width: float) -> Legend:
    """Add a legend below a panel, in as many columns as fit.

    Parameters
    ----------
    axes
        The panel.
    handles
        Of the entries.
    offset
        From the lower edge of the panel to the legend, in points.
    width
        Available, in points.
    """
    place: dict[str, Any] = {
        "loc": "upper left", "bbox_to_anchor": (0.0, -offset / size_in_points(axes)[1]), "borderaxespad": 0.0, "borderpad": 0.0,
    }  # fmt: skip
    figure, columns = figure_of(axes), 1
    for _ in range(2):
        legend = axes.legend(handles=list(handles), ncols=columns, **place, **_legend_style())
        set_font(figure)
        spacing = legend.columnspacing * LETTER
        widest = legend.get_window_extent().width * POINTS_PER_INCH / figure.dpi
        columns = max(1, min(len(handles), int((width + spacing) // (widest + spacing))))
    _colour_text(legend)
    return legend


def size_in_points(axes: Axes) -> tuple[float, float]:
    """Width and height of a panel."""
    box, scale = axes.get_window_extent(), POINTS_PER_INCH / figure_of(axes).dpi
    return float(box.width * scale), float(box.height * scale)


def figure_of(axes: Axes) -> Figure:
    """Figure of a panel."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    return figure


def _legend_style() -> dict[str, Any]:
    return {"frameon": False, "fontsize": LETTER - 1.0, "handlelength": 1.4, "handleheight": 0.9, "columnspacing": 1.3}


def add_panel_legend(axes: Axes, corner: Corner, columns: int = 1) -> None:
    """Add a legend inside a panel."""
    legend = axes.legend(
        loc=corner, ncols=columns, fontsize=SMALL, framealpha=0.85, edgecolor="none",
        handlelength=1.7, labelspacing=0.3, columnspacing=1.2, borderaxespad=0.4,
    )  # fmt: skip
    _colour_text(legend)


def _colour_text(legend: Legend) -> None:
    for text in legend.get_texts():
        text.set_color(LIGHT.text)


def set_font(figure: Figure) -> None:
    """Set one font family on every text of a figure; Matplotlib's rcParams would change it for the whole process."""
    for axes in figure.axes:
        axes.tick_params(labelfontfamily=_FAMILY, which="both")
    for text in figure.findobj(Text):
        text.set_fontfamily(_FAMILY)
        text.set_math_fontfamily(_MATHS)


def software() -> str:
    """Name and version of this program, for the metadata of files."""
    return f"escape-explorer {metadata.version('escape-explorer')}"


def save_figure(figure: Figure, ending: str, about: Mapping[str, str | datetime | None], *, crop: bool = False) -> bytes:
    """Save a figure to bytes; equal figures give equal bytes.

    Parameters
    ----------
    figure
        What to save.
    ending
        ``png`` or ``pdf``.
    about
        Metadata of the file. A date of None is left out.
    crop
        Whether the file shows exactly what was drawn, in whole pixels, instead of the figure's own size.
    """
    set_font(figure)
    box = _whole_pixels(figure) if crop else None
    file = BytesIO()
    figure.savefig(file, format=ending, dpi=figure.dpi if crop else RESOLUTION, metadata=dict(about), bbox_inches=box)
    # Freeze the layout for the next file.
    figure.set_layout_engine("none")
    return file.getvalue()


def _whole_pixels(figure: Figure) -> Bbox:
    """Bounding box of everything drawn, in inches, with a margin, extended to whole pixels."""
    box, dpi = figure.get_tightbbox(), figure.dpi
    low = [math.floor(edge * dpi) - _MARGIN for edge in (box.x0, box.y0)]
    high = [math.ceil(edge * dpi) + _MARGIN for edge in (box.x1, box.y1)]
    return Bbox.from_extents(*(edge / dpi for edge in (*low, *high)))
