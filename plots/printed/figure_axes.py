"""Apply the style of all figures: text sizes, axes, panel titles, legends and reproducible files.

Figures use Matplotlib's object-oriented API. Matplotlib is not thread-safe: threads draw and save under `RENDER_LOCK`.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterable, Mapping, Sequence
from io import BytesIO
from textwrap import fill
from typing import Any, Literal

from matplotlib import rc_context
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator, NullFormatter
from matplotlib.transforms import Bbox, ScaledTranslation, Transform

from plots.pictures.palette import LIGHT, PATCH_EDGE, Entry, Mark
from plots.pictures.provenance import program_version
from plots.printed.figure_style import CM_PER_INCH, POINTS_PER_INCH, SCREEN, FigureFormat, FigureStyle

RENDER_LOCK = threading.Lock()
"""A thread holds this lock while it draws and saves a figure."""

MOST_PIXELS = 20_000_000
"""Largest number of pixels of a PNG file: a figure of four maps, 16 cm wide in all, at 600 pixels per inch.

Drawing needs up to 50 bytes per pixel.
"""

# Fonts of texts. Matplotlib contains the first two. STIX has Greek letters, fractions and mathematical symbols. DejaVu Serif has
# superscripts that STIX lacks.
_FONT_FAMILIES = ["STIXGeneral", "DejaVu Serif", "serif"]
# Fonts of formulas.
_MATH_FONT = "stix"
# Settings of Matplotlib while a file is saved.
_FILE_OPTIONS: Any = {
    # Text in SVG files stays text. Programs without the STIX fonts show it in another font of about the same width.
    "svg.fonttype": "none",
    "font.serif": ["STIXGeneral", "Times New Roman", "Times", "Liberation Serif", "DejaVu Serif"],
    # PDF files contain TrueType fonts, whose text can be selected and edited.
    "pdf.fonttype": 42,
    # Elements have the same names in every file.
    "svg.hashsalt": "escape-explorer",
}
# Width of the lines of frames and ticks, in points.
_FRAME_WIDTH = 0.7
# Largest number of intervals between ticks on a linear axis.
_MOST_TICK_INTERVALS = 5
# Approximate number of letters in a line of text as wide as its font size.
_LETTERS_PER_EM = 2.0
# Largest number of columns of a legend below a panel.
_MOST_COLUMNS = 6
# Padding around panels, in inches.
_GAP = 0.07

# Width of a letter of a tick label, and space between tick labels, in units of the font size.
_LETTER_WIDTH, _BETWEEN_LABELS = 0.5, 1.0

Corner = Literal["upper left", "upper right", "lower left", "lower right", "center right", "best"]
"""Position of a legend in its panel."""


def new_figure(style: FigureStyle, height: float, title: str = "", *, equal: bool = False) -> Figure:
    """Return an empty figure, `height` cm high. `equal` packs panels that have the same scale on both axes."""
    layout = ConstrainedLayoutEngine(h_pad=_GAP, w_pad=_GAP, compress=equal)
    figure = Figure(figsize=(style.inches, height / CM_PER_INCH), dpi=style.dpi, layout=layout)
    if style.titles and title:
        figure.suptitle(title, fontsize=style.title_size, color=LIGHT.text)
    return figure


def write_below(figure: Figure, lines: Iterable[str], style: FigureStyle, size: float | None = None) -> None:
    """Write lines below all panels, wrapped to the width of the figure. `size` is the font size in points, by default small."""
    font_size = style.small_size if size is None else size
    letters = int(_LETTERS_PER_EM * style.inches * POINTS_PER_INCH / font_size)
    text = "\n".join(fill(line, letters, break_on_hyphens=False) for line in lines)
    figure.supxlabel(text, x=_GAP / style.inches, ha="left", fontsize=font_size, color=LIGHT.text)


def fit_height(figure: Figure) -> None:
    """Fit the height of a figure to its panels and the lines below them. Their sizes follow from the width of the figure."""
    # In a figure that is much too high, rows of panels are far apart, so the first fitted height can still be too large.
    for _ in range(2):
        figure.draw_without_rendering()
        panels = Bbox.union([box for axes in figure.axes if (box := axes.get_tightbbox()) is not None])
        text_height = sum(text.get_window_extent().height for text in figure.texts)
        gaps = 2 + 2 * len(figure.texts)
        figure.set_figheight((panels.height + text_height) / figure.dpi + gaps * _GAP)


def label_axes(axes: Axes, x_label: str, y_label: str, style: FigureStyle = SCREEN) -> None:
    """Label both axes."""
    axes.set_xlabel(x_label, fontsize=style.font_size)
    axes.set_ylabel(y_label, fontsize=style.font_size)


def style_axes(
    axes: Axes, style: FigureStyle = SCREEN, *, grid: bool = False, labels: tuple[str, str] | None = None, title: str = ""
) -> None:
    """Give axes a thin frame, short ticks, at most five intervals between ticks on linear axes, and optionally a faint grid.

    `labels` are the labels of the x axis and the y axis. `title` is the title of the panel, see `set_title`.
    """
    axes.tick_params(direction="out", labelsize=style.small_size, width=_FRAME_WIDTH, length=3.0, which="major")
    axes.tick_params(direction="out", width=0.6 * _FRAME_WIDTH, length=1.8, which="minor")
    for spine in axes.spines.values():
        spine.set_linewidth(_FRAME_WIDTH)
    for axis, scale in ((axes.xaxis, axes.get_xscale()), (axes.yaxis, axes.get_yscale())):
        if scale == "log":
            axis.set_minor_formatter(NullFormatter())
        else:
            axis.set_major_locator(MaxNLocator(_MOST_TICK_INTERVALS, steps=[1, 2, 5, 10]))
    if grid:
        axes.grid(alpha=0.25, linewidth=0.5)
    if labels is not None:
        label_axes(axes, *labels, style)
    if title:
        set_title(axes, title, style)


def label_width(label: str) -> float:
    """Return the approximate width of a tick label with the space around it, in units of its font size."""
    return _LETTER_WIDTH * len(label) + _BETWEEN_LABELS


def set_title(axes: Axes, title: str, style: FigureStyle = SCREEN) -> None:
    """Write the title of a panel above its left end, if the style has titles."""
    if style.titles:
        axes.set_title(title, loc="left", fontsize=style.font_size, color=LIGHT.text, pad=4.0)


def set_titles(panels: Iterable[Axes], titles: Sequence[str]) -> None:
    """Write the titles of panels after the letters (a), (b), …."""
    for letter, axes, title in zip("abcdefghi", panels, titles, strict=False):
        set_title(axes, f"({letter}) {title}")


def legend_handles(entries: Iterable[Entry]) -> list[Artist]:
    """Return Matplotlib's handles of the entries of a legend."""
    return [_HANDLES[entry.mark](entry) for entry in entries]


def _patch_handle(entry: Entry) -> Artist:
    return Patch(facecolor=entry.colour, edgecolor=PATCH_EDGE, linewidth=0.5, label=entry.label)


def _line_handle(entry: Entry) -> Artist:
    return Line2D([], [], color=entry.colour, linewidth=1.2, label=entry.label)


def _chessboard_handle(entry: Entry) -> Artist:
    return Patch(facecolor=entry.second_colour, edgecolor=entry.colour, hatch="xxxxx", linewidth=0.5, label=entry.label)


_HANDLES = {Mark.PATCH: _patch_handle, Mark.LINE: _line_handle, Mark.CHESSBOARD: _chessboard_handle}


def add_figure_legend(figure: Figure, handles: Sequence[Artist], style: FigureStyle = SCREEN, columns: int | None = None) -> None:
    """Add a legend for the whole figure below all panels, by default in one row."""
    column_count = len(handles) if columns is None else columns
    _colour_text(figure.legend(handles=list(handles), loc="outside lower center", ncols=column_count, **legend_style(style)))


def transform_below(axes: Axes, depth: float, left: float = 0.0) -> Transform:
    """Return the transform from shares of a panel to pixels, moved down by `depth` and to the left by `left` points."""
    offset = ScaledTranslation(-left / POINTS_PER_INCH, -depth / POINTS_PER_INCH, figure_of(axes).dpi_scale_trans)
    return axes.transAxes + offset


def add_legend_below(
    axes: Axes, entries: Mapping[str, Artist], place: tuple[float, float], width: float, style: Mapping[str, Any]
) -> Legend:
    """Add a legend below a panel, in as many columns as fit.

    Parameters
    ----------
    axes
        The panel.
    entries
        Handles of the legend entries, by label.
    place
        Upper left corner of the legend: distances to the left of, and below, the lower left corner of the panel, in points.
    width
        Available width in points. Longer entries are wrapped.
    style
        Options of `matplotlib.axes.Axes.legend`, such as `legend_style`.
    """
    left, depth = place
    options = {
        "loc": "upper left", "bbox_to_anchor": (0.0, 0.0), "bbox_transform": transform_below(axes, depth, left),
        "borderaxespad": 0.0, "borderpad": 0.0, **style,
    }  # fmt: skip
    labels, handles = [*entries], [*entries.values()]
    for columns in range(min(len(labels), _MOST_COLUMNS), 0, -1):
        legend = axes.legend(handles, labels, ncols=columns, **options)
        width_ratio = width * figure_of(axes).dpi / POINTS_PER_INCH / legend.get_window_extent().width
        if width_ratio >= 1.0:
            break
    else:
        # A single column is too wide: wrap its labels.
        labels = [fill(label, max(1, int(width_ratio * max(map(len, labels))))) for label in labels]
        legend = axes.legend(handles, labels, **options)
    _colour_text(legend)
    return legend


def size_in_points(axes: Axes) -> tuple[float, float]:
    """Return the width and height of a panel, in points."""
    box, scale = axes.get_window_extent(), POINTS_PER_INCH / figure_of(axes).dpi
    return float(box.width * scale), float(box.height * scale)


def figure_of(artist: Artist) -> Figure:
    """Return the figure that contains a panel or a text."""
    figure = artist.get_figure(root=True)
    assert figure is not None
    return figure


def legend_style(style: FigureStyle) -> dict[str, Any]:
    """Return the options of the legends of a figure."""
    font = {"family": _FONT_FAMILIES, "size": style.font_size * 11.0 / 12.0}
    return {"frameon": False, "prop": font, "handlelength": 1.4, "handleheight": 0.9, "columnspacing": 1.3}


def add_panel_legend(axes: Axes, corner: Corner, style: FigureStyle = SCREEN, columns: int = 1) -> None:
    """Add a legend inside a panel."""
    legend = axes.legend(
        loc=corner, ncols=columns, fontsize=style.small_size, framealpha=0.85, edgecolor="none",
        handlelength=1.7, labelspacing=0.3, columnspacing=1.2, borderaxespad=0.4,
    )  # fmt: skip
    _colour_text(legend)


def _colour_text(legend: Legend) -> None:
    for text in legend.get_texts():
        text.set_color(LIGHT.text)


def set_font(figure: Figure) -> None:
    """Set one font family on every text of a figure. Matplotlib's rcParams would set the family for the whole process."""
    for axes in figure.axes:
        axes.tick_params(labelfontfamily=_FONT_FAMILIES, which="both")
    for text in figure.findobj(Text):
        text.set_fontfamily(_FONT_FAMILIES)
        text.set_math_fontfamily(_MATH_FONT)


def save_figure(figure: Figure, format: FigureFormat, facts: Mapping[str, str]) -> bytes:
    """Return the content of the file of a figure. Equal figures have equal bytes.

    Parameters
    ----------
    figure
        Figure to save.
    format
        File format.
    facts
        Description of the figure in the metadata of the file.

    Raises
    ------
    ValueError
        If a PNG file would have more than `MOST_PIXELS`.
    """
    if format is FigureFormat.PNG:
        _check_pixels(figure)
    set_font(figure)
    file = BytesIO()
    with rc_context(_FILE_OPTIONS):
        figure.savefig(file, format=format, dpi=figure.dpi, metadata=_metadata(format, facts))
    # Freeze the layout, so that further files of this figure have the same layout.
    figure.set_layout_engine("none")
    return file.getvalue()


def _check_pixels(figure: Figure) -> None:
    width, height = figure.get_size_inches()
    largest_dpi = math.sqrt(MOST_PIXELS / (width * height))
    if figure.dpi > largest_dpi:
        size = f"{width * CM_PER_INCH:.3g} × {height * CM_PER_INCH:.3g} cm"
        raise ValueError(f"dpi={figure.dpi:g}: must be at most {math.floor(largest_dpi)} for a figure of {size}")


def _metadata(format: FigureFormat, facts: Mapping[str, str]) -> dict[str, str | None]:
    """Return the facts in the metadata fields of a format, without the date."""
    sentence = ", ".join(f"{name}: {value}" for name, value in facts.items())
    match format:
        case FigureFormat.PNG:
            return {"Software": program_version(), **facts}
        case FigureFormat.SVG:
            return {"Creator": program_version(), "Description": sentence, "Date": None}
        case FigureFormat.PDF:
            return {"Creator": program_version(), "Producer": program_version(), "Subject": sentence, "CreationDate": None}
