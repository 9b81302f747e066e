"""Picture files of maps have the right colours, positions and texts."""

from __future__ import annotations

import math
from io import BytesIO
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from matplotlib import ft2font
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont
from PIL import Image, ImageColor

from engine import (
    CASES,
    EscapeMap,
    Fate,
    MapSpec,
    Plane,
    Trust,
    compute_map,
    compute_trust,
    find_stable_manifolds,
)
from plots.layers.map_images import picture_pixels
from plots.layers.regularity import entries as entries_of_regularity
from plots.layers.table import TITLES
from plots.layers.trust import TONES
from plots.pictures.axis_labels import label_axis
from plots.pictures.palette import PALETTES, PAPER, Palette
from plots.pictures.provenance import provenance_line
from plots.pictures.time_scale import TimeScale
from plots.printed.figure_axes import save_figure
from plots.printed.figure_style import CM_PER_INCH, FigureFormat, FigureStyle
from plots.printed.map_figure import draw_map_figure

STYLE = FigureStyle(8.0, dpi=100.0)


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    """Return a map whose quarters all differ."""
    return compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.18, (40, 30), window=(-1.0, 1.4, -0.8, 0.4), t_max=200.0))


def draw(frame: EscapeMap, picture: str, palette: Palette, **options: Any) -> tuple[Image.Image, np.ndarray]:
    """Return a figure of one picture, and the pixels inside the frame of its map, of shape (rows, columns, 3)."""
    figure = draw_map_figure(frame, [picture], palette, STYLE, **options)
    image = Image.open(BytesIO(save_figure(figure, FigureFormat.PNG, {}))).convert("RGB")
    box = figure.axes[0].get_window_extent()
    left, right = math.ceil(box.x0), math.floor(box.x1)
    top, bottom = math.ceil(image.height - box.y1), math.floor(image.height - box.y0)
    return image, np.asarray(image)[top:bottom, left:right]


def rgba(colour: str) -> tuple[int, ...]:
    return ImageColor.getcolor(colour, "RGBA")


def number(label: str) -> float:
    return float(label.replace("−", "-"))


def on_white(colour: str) -> tuple[int, ...]:
    page = Image.new("RGBA", (1, 1), "white")
    page.alpha_composite(Image.new("RGBA", (1, 1), colour))
    return page.getpixel((0, 0))[:3]


def share_shown(square: np.ndarray, frame: EscapeMap, picture: str, palette: Palette) -> float:
    """Return the share of starts whose pixels have the right colour at the centre. Curves and marks cover some centres."""
    bare = picture_pixels(frame, picture, palette).astype(float)
    expected = 255 + (bare[..., :3] - 255) * bare[..., 3:] / 255
    rows, columns = (
        ((np.arange(n) + 0.5) * side / n).astype(int) for n, side in zip(bare.shape[:2], square.shape[:2], strict=True)
    )
    return float(np.mean(np.all(np.abs(square[np.ix_(rows, columns)] - expected) <= 1, axis=-1)))


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_pixels_have_the_colour_of_their_fate_with_row_0_at_the_bottom(escape_map: EscapeMap, palette: Palette) -> None:
    pixels = picture_pixels(escape_map, "basins", palette)
    assert (pixels.shape, pixels.dtype) == ((30, 40, 4), np.uint8)
    for channel in (1, 2, 3):
        where = escape_map.fate[::-1] == channel
        assert where.any()
        assert np.all(pixels[where] == rgba(palette.channels[channel - 1]))
    for fate in (Fate.BOUNDED, Fate.FORBIDDEN, Fate.OUTSIDE):
        assert np.all(pixels[escape_map.fate[::-1] == fate] == rgba(palette.outcomes[fate].colour))


@pytest.mark.parametrize(("picture", "palette"), [("basins", "safe"), ("times", "paper"), ("crossings", "paper")])
def test_the_map_fills_its_frame_on_white(escape_map: EscapeMap, picture: str, palette: str) -> None:
    image, square = draw(escape_map, picture, PALETTES[palette])
    assert share_shown(square, escape_map, picture, PALETTES[palette]) > 0.9
    assert np.all(np.asarray(image)[0] == 255)


def test_maps_of_equal_size_wrap_into_rows(escape_map: EscapeMap) -> None:
    columns = 2
    style = FigureStyle(width=5.5 * columns, dpi=100.0)
    assert style.columns(len(TITLES)) == columns
    figure = draw_map_figure(escape_map, list(TITLES), PAPER, style)
    figure.draw_without_rendering()
    boxes = np.array([axes.get_window_extent().extents for axes in figure.axes])
    np.testing.assert_allclose(boxes[:, 2:] - boxes[:, :2], boxes[0, 2] - boxes[0, 0], rtol=1e-9)
    assert len(np.unique(boxes[:, 0].round())) == columns
    assert len(np.unique(boxes[:, 1].round())) == math.ceil(len(TITLES) / columns)


@pytest.mark.slow
@pytest.mark.parametrize("style", [FigureStyle(4.0, font_size=6.0), FigureStyle(17.0, 150.0, 11.0)])
def test_everything_is_inside_the_figure_and_nothing_overlaps(style: FigureStyle, escape_map: EscapeMap) -> None:
    figure = draw_map_figure(escape_map, list(TITLES), PAPER, style, starts=[(0.8, 0.1)])
    figure.draw_without_rendering()
    assert figure.get_size_inches()[0] == pytest.approx(style.width / CM_PER_INCH)
    page, boxes = figure.bbox, [axes.get_tightbbox() for axes in figure.axes]
    boxes += [text.get_window_extent() for text in figure.texts]
    for number, box in enumerate(boxes):
        assert page.x0 <= box.x0 < box.x1 <= page.x1 + 1
        assert page.y0 <= box.y0 < box.y1 <= page.y1 + 1
        assert not any(box.overlaps(other) for other in boxes[:number])


@pytest.fixture(scope="module")
def three_maps() -> Figure:
    """Return a figure as wide as a page, with many entries in its legends."""
    whole = compute_map(MapSpec(CASES["III"], Plane.X_Y, 0.3, (30, 30), t_max=1000.0))
    trust = {"trust": compute_trust(whole)}
    figure = draw_map_figure(whole, ["basins", "times", "crossings"], PAPER, FigureStyle(), analyses=trust)
    figure.draw_without_rendering()
    return figure


def test_long_legends_leave_maps_their_width(three_maps: Figure) -> None:
    column = three_maps.bbox.width / 3
    assert all(axes.get_window_extent().width > 0.65 * column for axes in three_maps.axes)


def test_labels_of_a_narrow_colour_bar_do_not_touch(three_maps: Figure) -> None:
    (bar,) = three_maps.axes[1].child_axes
    boxes = [label.get_window_extent() for label in bar.get_xticklabels()]
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))


def test_an_entry_is_in_one_legend_of_a_figure(three_maps: Figure) -> None:
    legends = [legend for axes in three_maps.axes if (legend := axes.get_legend())]
    labels = [text.get_text() for legend in legends for text in legend.get_texts()]
    assert {"exit 1", "bounded", "limiting curve", "> 10", "doubtful pixels"} < set(labels)
    assert len(set(labels)) == len(labels)


def test_a_figure_without_titles_has_no_provenance_either(escape_map: EscapeMap) -> None:
    figure = draw_map_figure(escape_map, ["basins"], PAPER, FigureStyle(titles=False))
    assert [axes.get_title(loc="left") for axes in figure.axes] == [""]
    assert not figure.texts


def test_a_start_is_marked_in_the_colour_of_its_orbit(escape_map: EscapeMap) -> None:
    starts = [(5.0, 5.0), (0.8, 0.1)]
    _, marked = draw(escape_map, "characters", PAPER, starts=starts)
    _, plain = draw(escape_map, "characters", PAPER)
    rows, columns = np.nonzero(np.any(marked != plain, axis=-1))
    side = plain.shape[0]
    assert abs(columns.min() - 0.75 * side) < 15
    assert abs(rows.max() - 0.25 * side) < 15
    # The first start is outside the window, and the second start still has the second colour.
    row, column = round(0.25 * side), round(0.75 * side)
    near = marked[row - 2 : row + 2, column - 2 : column + 2]
    assert np.any(np.all(near == on_white(PAPER.orbits[1]), axis=-1))


@pytest.mark.parametrize(
    ("low", "high", "labels"),
    [
        (-0.76, 0.76, ["−0.5", "0.0", "0.5"]),
        (0.31, 0.3113, ["0.3100", "0.3102", "0.3104", "0.3106", "0.3108", "0.3110", "0.3112"]),
        (-100.0, 100.0, ["−100", "−50", "0", "50", "100"]),
    ],
)
def test_ticks_are_at_round_numbers(low: float, high: float, labels: list[str]) -> None:
    name, ticks = label_axis("x", low, high)
    assert (name, [label for _, label in ticks]) == ("x", labels)
    assert [place for place, _ in ticks] == [number(label) for label in labels]


@pytest.mark.parametrize("centre", [-0.3541234567, 0.0])
@pytest.mark.parametrize("width", [1e-5, 1e-12])
def test_ticks_of_a_deep_zoom_are_distinct(centre: float, width: float) -> None:
    low, high = centre - width / 2, centre + width / 2
    name, ticks = label_axis("x", low, high)
    labels = [label for _, label in ticks]
    assert 3 <= len(labels) == len(set(labels))
    assert max(map(len, labels)) <= 3
    offset, unit = name.removeprefix("(").split(" / ")
    middle = -number(offset.removeprefix("x").removesuffix(")").replace(" ", "") or "0")
    power = 10.0 ** int(unit.removeprefix("10").translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")))
    values = [middle + number(label) * power for label in labels]
    np.testing.assert_allclose(values, [place for place, _ in ticks], rtol=0, atol=1e-3 * width + 1e-16)


def test_the_fonts_have_every_character_of_the_texts(escape_map: EscapeMap) -> None:
    entries = [
        *PAPER.outcomes.values(),
        *PAPER.crossing_entries,
        *entries_of_regularity(PAPER),
        *PAPER.end_entries(CASES["III"].outcomes),
    ]
    texts = [
        *(entry.label for entry in entries),
        *TITLES.values(),
        provenance_line(escape_map),
        "(x − 0.12) / 10⁻¹¹",
        "R²",
        "0.05x⁴",
    ]
    fonts = [ft2font.FT2Font(findfont(FontProperties(family=family))) for family in ("STIXGeneral", "DejaVu Serif")]
    missing = [each for each in set("".join(texts)) if not any(font.get_char_index(ord(each)) for font in fonts)]
    assert missing == []


def test_doubtful_pixels_are_marked_and_have_an_entry() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (60, 60), t_max=500.0))
    trust = compute_trust(whole)
    pixels = picture_pixels(whole, "basins", PAPER, {"trust": trust})[::-1]
    marked = [np.all(pixels == rgba(tone), axis=-1) for tone in TONES]
    np.testing.assert_array_equal(marked[0] | marked[1], trust.trust == Trust.DOUBTFUL)
    assert all(tone.any() for tone in marked)
    legend = draw_map_figure(whole, ["basins"], PAPER, STYLE, analyses={"trust": trust}).axes[0].get_legend()
    assert legend is not None
    assert "doubtful pixels" in [text.get_text() for text in legend.get_texts()]


def draw_with_manifolds(picture: str) -> Axes:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.3, (60, 60), t_max=100.0))
    found = {"manifolds": find_stable_manifolds(CASES["II"], 0.3, images=1)}
    return draw_map_figure(whole, [picture], PAPER, STYLE, analyses=found).axes[0]


def curve_colours(axes: Axes) -> set[str]:
    return {to_hex(curve.get_edgecolor()[0]) for curve in axes.collections if isinstance(curve, LineCollection)}


def test_manifolds_have_the_colours_of_their_channels_and_an_entry_for_each() -> None:
    axes = draw_with_manifolds("crossings")
    assert set(PAPER.channels[:3]) <= curve_colours(axes)
    legend = axes.get_legend()
    assert legend is not None
    labels = [text.get_text() for text in legend.get_texts()]
    assert [label for label in labels if "manifold" in label] == [f"stable manifold {k}" for k in (1, 2, 3)]
    assert not any(label.startswith("_") for label in labels)


def test_manifolds_are_not_drawn_over_escape_times() -> None:
    assert curve_colours(draw_with_manifolds("times")).isdisjoint(PAPER.channels[:3])


def test_locked_limits_are_used_for_the_pixels_and_the_colour_bar(escape_map: EscapeMap) -> None:
    figure = draw_map_figure(escape_map, ["times"], PAPER, FigureStyle(12.0), times=TimeScale(2.5, 5000.0))
    _, times = figure.axes[0].images
    expected = picture_pixels(escape_map, "times", PAPER, times=TimeScale(2.5, 5000.0))
    shown = times.to_rgba(times.get_array(), bytes=True)
    has_escaped = (escape_map.fate > Fate.BOUNDED)[::-1]
    assert has_escaped.any()
    np.testing.assert_array_equal(shown[has_escaped], expected[has_escaped])
    bar = figure.axes[0].child_axes[0]
    labels = [tick.get_text() for tick in bar.get_xticklabels()]
    assert labels == ["≤ 2.5", "10", "100", "1000", "≥ 5000"]


def test_lyapunov_orbits_have_the_colours_of_their_channels() -> None:
    whole = compute_map(MapSpec(CASES["I"], Plane.X_Y, 0.2, (30, 30), t_max=100.0))
    _, square = draw(whole, "times", PAPER)
    for channel in (1, 2):
        assert np.sum(np.all(square == on_white(PAPER.channels[channel - 1]), axis=-1)) > 50
