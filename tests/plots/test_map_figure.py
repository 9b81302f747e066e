"""Picture files of maps: colours, positions and texts."""

from __future__ import annotations

import math
from io import BytesIO
from typing import Any

import numpy as np
import pytest
from matplotlib import ft2font
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex
from matplotlib.font_manager import FontProperties, findfont
from matplotlib.text import Text
from PIL import Image, ImageColor

from engine import (
    CASES,
    EscapeMap,
    Fate,
    MapSpec,
    Plane,
    Regularity,
    Trust,
    compute_map,
    compute_regularity,
    compute_trust,
    find_stable_manifolds,
)
from plots.axis_labels import label_axis
from plots.figure_axes import save_figure
from plots.figure_style import CM_PER_INCH, FigureFormat, FigureStyle
from plots.map_analyses import MapAnalyses
from plots.map_figure import draw_map_figure, provenance_line
from plots.map_images import TITLES, picture_pixels
from plots.palette import DOUBT, PALETTES, PAPER, Palette
from plots.time_scale import TimeScale

STYLE = FigureStyle(8.0, dpi=100.0)


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    """A map whose quarters all differ."""
    return compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.18, (40, 30), window=(-1.0, 1.4, -0.8, 0.4), t_max=200.0))


def draw(frame: EscapeMap, picture: str, palette: Palette, **options: Any) -> tuple[Image.Image, np.ndarray]:
    """A figure of one picture, and the pixels (rows, columns, 3) inside the frame of its map."""
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
    """Share of the starts whose pixel has its colour at its centre; curves and marks cover a few of them."""
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


def test_slow_escapes_have_later_colours_and_others_that_of_their_outcome(escape_map: EscapeMap) -> None:
    pixels = picture_pixels(escape_map, "times", PAPER)[::-1]
    escaped = escape_map.fate > 0
    scale = [rgba(colour) for colour in PAPER.escape_time]
    places = np.array([scale.index(tuple(pixel)) for pixel in pixels[escaped].tolist()])
    assert np.all(np.diff(places[np.argsort(escape_map.escape_time[escaped])]) >= 0)
    assert (places.min(), places.max()) == (places[np.argmin(escape_map.escape_time[escaped])], 255)
    assert np.all(pixels[escape_map.fate == Fate.BOUNDED] == rgba(PAPER.bounded))


def test_classified_orbits_have_the_colour_of_their_class() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.15, (25, 25), t_max=2000.0))
    regularity = compute_regularity(whole)
    pixels = picture_pixels(whole, "characters", PAPER, MapAnalyses(regularity=regularity))[::-1]
    for character in (Regularity.REGULAR, Regularity.CHAOTIC, Regularity.NO_SIGN_OF_CHAOS):
        colour = PAPER.character_entries[character].colour
        where = regularity.character == character
        assert where.any()
        assert np.all(pixels[where] == rgba(colour))


def test_a_coarse_frame_has_a_pixel_for_each_start() -> None:
    frames: list[EscapeMap] = []
    compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (120, 90), t_max=50.0), on_frame=frames.append)
    assert frames[0].stride > 1
    pixels = picture_pixels(frames[0], "basins", PAPER)
    assert pixels.shape == (90, 120, 4)
    assert not np.any(np.all(pixels == rgba(PAPER.outcomes[Fate.NOT_COMPUTED].colour), axis=-1))


@pytest.mark.parametrize(("picture", "palette"), [*((picture, "paper") for picture in TITLES), ("basins", "safe")])
def test_the_map_fills_its_frame_on_white(escape_map: EscapeMap, picture: str, palette: str) -> None:
    image, square = draw(escape_map, picture, PALETTES[palette])
    assert share_shown(square, escape_map, picture, PALETTES[palette]) > 0.9
    assert np.all(np.asarray(image)[0] == 255)


@pytest.mark.parametrize("columns", [1, 2, 3])
def test_maps_of_equal_size_wrap_into_rows(columns: int, escape_map: EscapeMap) -> None:
    style = FigureStyle(width=5.5 * columns, dpi=100.0)
    assert style.columns(len(TITLES)) == columns
    figure = draw_map_figure(escape_map, list(TITLES), PAPER, style)
    figure.draw_without_rendering()
    boxes = np.array([axes.get_window_extent().extents for axes in figure.axes])
    np.testing.assert_allclose(boxes[:, 2:] - boxes[:, :2], boxes[0, 2] - boxes[0, 0], rtol=1e-9)
    assert len(np.unique(boxes[:, 0].round())) == columns
    assert len(np.unique(boxes[:, 1].round())) == len(TITLES) / columns


@pytest.mark.slow
@pytest.mark.parametrize(
    "style", [FigureStyle(4.0, font_size=6.0), FigureStyle(6.0), FigureStyle(17.0, 150.0, 11.0), FigureStyle(12.0, titles=False)]
)
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


def test_a_figure_without_titles_has_no_provenance_either(escape_map: EscapeMap) -> None:
    figure = draw_map_figure(escape_map, ["basins"], PAPER, FigureStyle(titles=False))
    assert [axes.get_title(loc="left") for axes in figure.axes] == [""]
    assert not figure.texts


def test_letters_have_the_given_size(escape_map: EscapeMap) -> None:
    figure = draw_map_figure(escape_map, ["basins"], PAPER, FigureStyle(font_size=7.0))
    assert figure.axes[0].xaxis.label.get_fontsize() == 7.0
    assert max(text.get_fontsize() for text in figure.findobj(Text) if text.get_text()) == 7.0


def test_an_unknown_picture_is_rejected(escape_map: EscapeMap) -> None:
    with pytest.raises(ValueError, match=f"picture='orbits': must be one of {', '.join(TITLES)}"):
        picture_pixels(escape_map, "orbits", PAPER)


def test_a_start_is_marked_in_the_colour_of_its_orbit(escape_map: EscapeMap) -> None:
    starts = [(5.0, 5.0), (0.8, 0.1)]
    _, marked = draw(escape_map, "characters", PAPER, starts=starts)
    _, plain = draw(escape_map, "characters", PAPER)
    rows, columns = np.nonzero(np.any(marked != plain, axis=-1))
    side = plain.shape[0]
    assert abs(columns.min() - 0.75 * side) < 15
    assert abs(rows.max() - 0.25 * side) < 15
    # The first start is outside the window and keeps its colour.
    row, column = round(0.25 * side), round(0.75 * side)
    near = marked[row - 2 : row + 2, column - 2 : column + 2]
    assert np.any(np.all(near == on_white(PAPER.orbits[1]), axis=-1))


def test_lyapunov_orbits_have_the_colours_of_their_channels() -> None:
    whole = compute_map(MapSpec(CASES["I"], Plane.X_Y, 0.2, (30, 30), t_max=100.0))
    _, square = draw(whole, "times", PAPER)
    for channel in (1, 2):
        assert np.sum(np.all(square == on_white(PAPER.channels[channel - 1]), axis=-1)) > 50


@pytest.mark.parametrize(
    ("low", "high", "labels"),
    [
        (-0.76, 0.76, ["−0.5", "0.0", "0.5"]),
        (0.0, 1.0, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]),
        (0.31, 0.3113, ["0.3100", "0.3102", "0.3104", "0.3106", "0.3108", "0.3110", "0.3112"]),
        (-100.0, 100.0, ["−100", "−50", "0", "50", "100"]),
    ],
)
def test_ticks_are_at_round_numbers(low: float, high: float, labels: list[str]) -> None:
    name, ticks = label_axis("x", low, high)
    assert (name, [label for _, label in ticks]) == ("x", labels)
    np.testing.assert_allclose(
        [low + place * (high - low) for place, _ in ticks], [number(label) for label in labels], atol=1e-12
    )


@pytest.mark.parametrize("centre", [0.3541234567, -0.3541234567, 0.0])
@pytest.mark.parametrize("width", [1e-5, 1e-10, 1e-12])
def test_ticks_of_a_deep_zoom_are_distinct(centre: float, width: float) -> None:
    low, high = centre - width / 2, centre + width / 2
    name, ticks = label_axis("x", low, high)
    labels = [label for _, label in ticks]
    assert 3 <= len(labels) == len(set(labels))
    assert max(map(len, labels)) <= 3
    offset, unit = name.removeprefix("(").split(" / ")
    middle = -number(offset.removeprefix("x").removesuffix(")").replace(" ", "") or "0")
    values = [middle + number(label) * float(unit) for label in labels]
    np.testing.assert_allclose(values, [low + place * (high - low) for place, _ in ticks], rtol=0, atol=1e-3 * width + 1e-16)


def test_a_deep_zoom_next_to_an_exit_shows_its_map_and_start() -> None:
    spec = MapSpec(CASES["I"], Plane.X_Y, 0.2, (20, 20), window=(0.3541234567, 0.3541234568, 0.1, 0.1 + 1e-10), t_max=100.0)
    whole = compute_map(spec)
    for picture in TITLES:
        (_, plain), (_, marked) = (draw(whole, picture, PAPER, starts=starts) for starts in ([], [(0.35412345675, 0.1 + 5e-11)]))
        rows, columns = np.nonzero(np.any(plain != marked, axis=-1))
        assert 4 < np.ptp(rows) < 30
        assert 4 < np.ptp(columns) < 30
    (fate,) = np.unique(whole.fate)
    _, square = draw(whole, "basins", PAPER)
    assert np.mean(np.all(square == on_white(PAPER.channels[fate - 1]), axis=-1)) > 0.9


def test_a_map_over_energies_has_its_ordinate_and_no_single_energy() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_H, (1 / 6, 0.4), (20, 20), t_max=50.0))
    line = provenance_line(whole)
    assert "h = " not in line
    assert "h from 0.16666666666666666 to 0.4" in line
    assert share_shown(draw(whole, "crossings", PAPER)[1], whole, "crossings", PAPER) > 0.8


@pytest.mark.parametrize("picture", TITLES)
def test_a_map_without_escapes_shows_bounded_orbits(picture: str) -> None:
    whole = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.1, (10, 10), t_max=50.0))
    assert not np.any(whole.fate >= 1)
    assert np.any(whole.fate == Fate.BOUNDED)
    assert share_shown(draw(whole, picture, PAPER)[1], whole, picture, PAPER) > 0.8


def test_the_font_has_every_character_of_the_texts(escape_map: EscapeMap) -> None:
    entries = [
        *PAPER.outcomes.values(),
        *PAPER.crossing_entries,
        *PAPER.character_entries,
        *PAPER.end_entries(CASES["III"].outcomes),
    ]
    texts = [*(entry.label for entry in entries), *TITLES.values(), provenance_line(escape_map), "(x − 0.12) / 1e-11", "R²"]
    font = ft2font.FT2Font(findfont(FontProperties(family="STIXGeneral")))
    assert [character for character in set("".join(texts)) if not font.get_char_index(ord(character))] == []


def test_a_long_legend_wraps(escape_map: EscapeMap) -> None:
    legends = [
        draw_map_figure(escape_map, ["crossings"], PAPER, FigureStyle(width)).axes[0].get_legend() for width in (6.0, 16.0)
    ]
    narrow, wide = (legend.get_window_extent() for legend in legends if legend is not None)
    assert narrow.height > wide.height


def test_doubtful_pixels_are_marked() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (60, 60), t_max=500.0))
    trust = compute_trust(whole)
    pixels = picture_pixels(whole, "basins", PAPER, MapAnalyses(trust=trust))[::-1]
    marked = [np.all(pixels == rgba(tone), axis=-1) for tone in DOUBT]
    np.testing.assert_array_equal(marked[0] | marked[1], trust.trust == Trust.DOUBTFUL)
    assert all(tone.any() for tone in marked)


@pytest.mark.parametrize(("picture", "drawn_over"), [("basins", True), ("crossings", True), ("times", False)])
def test_manifolds_are_drawn_over_exits_basins_and_crossings(picture: str, drawn_over: bool) -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.3, (60, 60), t_max=100.0))
    found = MapAnalyses(manifolds=find_stable_manifolds(CASES["II"], 0.3, images=1))
    plain, printed = (
        draw_map_figure(whole, [picture], PAPER, STYLE, analyses=analyses).axes[0].collections
        for analyses in (MapAnalyses(), found)
    )
    assert (len(printed) > len(plain)) is drawn_over


def test_manifolds_have_the_colours_of_their_channels_and_an_entry_for_each() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.3, (60, 60), t_max=100.0))
    found = MapAnalyses(manifolds=find_stable_manifolds(CASES["II"], 0.3, images=1))
    figure = draw_map_figure(whole, ["crossings"], PAPER, STYLE, analyses=found)
    colours = [to_hex(curve.get_edgecolor()[0]) for curve in figure.axes[0].collections if isinstance(curve, LineCollection)]
    assert set(PAPER.channels[:3]) <= set(colours)
    legend = figure.axes[0].get_legend()
    assert legend is not None
    labels = [text.get_text() for text in legend.get_texts()]
    assert [label for label in labels if "manifold" in label] == [f"stable manifold of Lyapunov orbit {k}" for k in (1, 2, 3)]
    assert not any(label.startswith("_") for label in labels)


def test_doubtful_pixels_have_an_entry() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (60, 60), t_max=500.0))
    legend = (
        draw_map_figure(whole, ["basins"], PAPER, STYLE, analyses=MapAnalyses(trust=compute_trust(whole))).axes[0].get_legend()
    )
    assert legend is not None
    assert "doubtful" in [text.get_text() for text in legend.get_texts()]


def test_locked_limits_are_used_for_the_pixels_and_the_colour_bar(escape_map: EscapeMap) -> None:
    figure = draw_map_figure(escape_map, ["times"], PAPER, STYLE, times=TimeScale(2.5, 5000.0))
    np.testing.assert_array_equal(
        figure.axes[0].images[0].get_array(), picture_pixels(escape_map, "times", PAPER, times=TimeScale(2.5, 5000.0))
    )
    bar = figure.axes[0].child_axes[0]
    labels = [tick.get_text() for tick in bar.get_xticklabels()]
    assert labels == ["≤ 2.5", "10", "100", "1000", "≥ 5000"]
