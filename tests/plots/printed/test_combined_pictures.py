"""Results are drawn into axes of the caller, over each other, in colours of the caller."""

from __future__ import annotations

from io import BytesIO
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, to_rgba
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from engine import (
    Fate,
    LyapunovOrbit,
    MapSpec,
    Orbit,
    Plane,
    SweepSpec,
    compute_map,
    compute_sweep,
    integrate_orbit,
    start_states,
)
from engine.results import SampledOrbits
from tests.results import ENERGY, POTENTIAL, SPEC, result_of

WINDOW = SPEC.find_window()


def new_axes() -> Axes:
    return Figure(figsize=(4.0, 4.0), dpi=100, layout="constrained").subplots()


def pixels_of(axes: Axes) -> np.ndarray:
    """Return the pixels inside the axes, of shape (rows, columns, 3)."""
    figure = axes.figure
    assert isinstance(figure, Figure)
    file = BytesIO()
    figure.savefig(file, format="raw")
    box = axes.get_window_extent()
    whole = np.frombuffer(file.getvalue(), np.uint8).reshape(*figure.canvas.get_width_height()[::-1], 4)
    rows = whole.shape[0] - int(box.y1) + 2, whole.shape[0] - int(box.y0) - 2
    return whole[slice(*rows), int(box.x0) + 2 : int(box.x1) - 2, :3]


def share_of(colour: str, pixels: np.ndarray) -> float:
    expected = np.array(to_rgba(colour)[:3]) * 255.0
    return float(np.mean(np.all(np.abs(pixels - expected) <= 1.0, axis=-1)))


@pytest.mark.parametrize("name", ["manifolds", "periodic orbits", "returns"])
def test_a_map_stays_visible_under_further_results(name: str) -> None:
    axes = new_axes()
    result_of("map").plot(axes, palette={1: "tab:red"})
    before = share_of("tab:red", pixels_of(axes))
    drawing = result_of(name).plot(axes)
    after = pixels_of(axes)
    assert before > 0.05
    assert share_of("tab:red", after) > 0.6 * before
    assert drawing.artists
    assert np.any(after != pixels_of(alone("map", palette={1: "tab:red"})))


def alone(name: str, **options: Any) -> Axes:
    return result_of(name).plot(new_axes(), **options).ax


def test_crossings_of_an_orbit_lie_where_its_section_is_drawn() -> None:
    (start,) = start_states(POTENTIAL, Plane.X_PX, ENERGY, [0.55], [0.0])
    orbit = integrate_orbit(POTENTIAL, start, 500.0)
    axes = alone("map")
    (points,) = orbit.plot(axes, show="crossings").artists
    drawn = np.asarray(points.get_xydata())  # type: ignore[attr-defined]
    np.testing.assert_array_equal(drawn, orbit.find_section_crossings())
    assert len(drawn) > 10


def test_orbits_of_the_plane_of_positions_share_its_axes() -> None:
    axes = compute_map(MapSpec(POTENTIAL, Plane.X_Y, ENERGY, (20, 20), t_max=50.0)).plot(new_axes()).ax
    orbit, lyapunov, sampled = result_of("orbit"), result_of("Lyapunov orbit"), result_of("orbits")
    assert isinstance(orbit, Orbit)
    assert isinstance(lyapunov, LyapunovOrbit)
    assert isinstance(sampled, SampledOrbits)
    for result in (orbit, lyapunov, sampled, result_of("periodic orbit")):
        assert result.plot(axes).ax is axes
    (line,) = lyapunov.plot(axes).artists
    np.testing.assert_array_equal(line.get_xydata(), lyapunov.half_path)  # type: ignore[attr-defined]


def test_other_coordinates_than_those_of_the_axes_are_refused_before_anything_is_drawn() -> None:
    axes = alone("map")
    count = len(axes.get_children())
    with pytest.raises(ValueError, match=r"^ax: shows px against x; must be other axes for y against x$"):
        result_of("orbit").plot(axes)
    assert len(axes.get_children()) == count
    axes.clear()
    result_of("orbit").plot(axes)


@pytest.mark.parametrize("is_first", [True, False])
def test_what_the_caller_sets_before_or_afterwards_stays(*, is_first: bool) -> None:
    axes = new_axes()
    given = {"xlabel": "$x$", "ylabel": "$p_x$", "title": "mine", "xlim": (-0.2, 0.3), "ylim": (0.0, 0.1), "aspect": 2.0}
    if is_first:
        axes.set(**given)
    for name in ("map", "manifolds"):
        result_of(name).plot(axes, legend=True)
    if not is_first:
        axes.set(**given)
    axes.figure.draw_without_rendering()  # type: ignore[union-attr]
    assert {name: getattr(axes, f"get_{name}")() for name in given} == given
    assert axes.get_title(loc="left") == ""


def test_the_first_result_sets_labels_and_limits_that_are_missing() -> None:
    axes = alone("map")
    window = SPEC.find_window()
    result_of("manifolds").plot(axes)
    assert (axes.get_xlim(), axes.get_ylim()) == window.ranges
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x", "px")
    assert alone("orbit").get_aspect() == 1.0


@pytest.mark.parametrize("sharey", [True, "row", False])
def test_panels_that_share_an_axis_show_the_largest_map(*, sharey: bool | str) -> None:
    panels = Figure().subplots(1, 3, sharey=sharey)
    windows = []
    for axes, energy in zip(panels, (0.13, 0.3, 0.2), strict=True):
        spec = MapSpec(POTENTIAL, Plane.X_PX, energy, (8, 8), t_max=10.0)
        compute_map(spec).plot(axes)
        windows.append(spec.find_window().ranges[1])
    largest = min(low for low, _ in windows), max(high for _, high in windows)
    for axes, own in zip(panels, windows, strict=True):
        assert axes.get_ylim() == pytest.approx(largest if sharey else own)


def test_limits_that_the_caller_sets_on_shared_axes_stay() -> None:
    left, right = Figure().subplots(1, 2, sharey=True)
    result_of("map").plot(left)
    left.set_ylim(-0.1, 0.2)
    result_of("map").plot(right)
    assert right.get_ylim() == (-0.1, 0.2)


def test_charts_in_the_same_axes_are_seen_whole() -> None:
    axes = new_axes()
    for energies in ((0.2, 0.25), (0.25, 0.3)):
        request = SweepSpec(POTENTIAL, Plane.X_PX, energies, resolution=(12, 12), t_max=50.0, measures=("basin_entropy",))
        compute_sweep(request).plot(axes)
    assert axes.get_xlim() == (0.2, 0.3)


def test_pixels_have_the_colours_of_a_mapping_from_fates() -> None:
    colours = {1: "tab:orange", 2: "navy", Fate.BOUNDED: "0.85", Fate.FORBIDDEN: "pink"}
    drawing = result_of("map").plot(new_axes(), palette=colours)
    assert drawing.image is not None
    pixels = np.asarray(drawing.image.get_array())[::-1]
    for fate, colour in colours.items():
        has_fate = result_of("map").fate == fate  # type: ignore[attr-defined]
        assert has_fate.any()
        np.testing.assert_allclose(pixels[has_fate] / 255.0, np.broadcast_to(to_rgba(colour), pixels[has_fate].shape), atol=0.003)


@pytest.mark.parametrize(
    ("palette", "message"),
    [({9: "red"}, r"^palette: fate=9: must be a Fate, or the number of an outcome, 1 to 4$"),
     ({"exit 1": "red"}, "^palette: fate='exit 1': must be a Fate"),
     ({1: "reddish"}, "^palette: colour of fate 1='reddish': must be a colour of Matplotlib$")],
)  # fmt: skip
def test_a_wrong_mapping_is_refused(palette: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        result_of("map").plot(new_axes(), palette=palette)


@pytest.mark.parametrize(("name", "options"), [("map", {"picture": "times"}), ("descriptors", {})])
def test_the_image_of_a_picture_with_a_scale_holds_numbers_for_a_colour_bar(name: str, options: dict[str, Any]) -> None:
    result, norm = result_of(name), LogNorm(2.0, 50.0)
    values = result.escape_time if name == "map" else result.descriptor  # type: ignore[attr-defined]
    drawing = result.plot(new_axes(), colorbar=True, cmap="magma", norm=norm, **options)
    assert isinstance(drawing.image, AxesImage)
    np.testing.assert_allclose(np.ma.filled(drawing.image.get_array(), np.nan)[::-1], values, rtol=1e-6)
    assert drawing.image.get_cmap().name == "magma"
    assert drawing.colorbar is not None
    assert (drawing.colorbar.mappable, drawing.colorbar.norm) == (drawing.image, norm)


@pytest.mark.parametrize("option", ["cmap", "norm", "colorbar"])
def test_a_scale_is_refused_where_there_is_none(option: str) -> None:
    value = True if option == "colorbar" else "viridis"
    for name in ("map", "manifolds", "statistics"):
        with pytest.raises(TypeError, match=f"^{option}"):
            result_of(name).plot(new_axes(), **{option: value})


def test_legends_collect_the_entries_of_all_results() -> None:
    axes = alone("map", legend=True)
    legend = result_of("manifolds").plot(axes, legend=True).legend
    assert legend is axes.get_legend()
    labels = [text.get_text() for text in axes.get_legend().get_texts()]  # type: ignore[union-attr]
    assert {"exit 1", "bounded", "stable manifold 1", "limiting curve"} <= set(labels)
    assert len(labels) == len(set(labels))
    assert result_of("manifolds").plot(axes).legend is None


def test_panels_with_legends_and_colour_bars_do_not_overlap() -> None:
    figure = Figure(figsize=(6.7, 5.9), dpi=100, layout="constrained")
    panels = figure.subplots(2, 2).ravel()
    for axes, picture in zip(panels, ("basins", "times", "crossings", "curves"), strict=True):
        result_of("map").plot(axes, picture=picture, legend=picture != "times", colorbar=picture == "times")
    figure.draw_without_rendering()
    boxes = [axes.get_tightbbox() for axes in figure.axes]
    assert not any(first.overlaps(second) for first, second in combinations(boxes, 2))
    assert all(axes.get_window_extent().width > 150 for axes in panels)


def test_a_single_column_holds_labels_and_colour_bar() -> None:
    figure = Figure(figsize=(8.5 / 2.54, 8.0 / 2.54), dpi=100, layout="constrained")
    result_of("map").plot(figure.subplots(), picture="times", colorbar=True)
    figure.draw_without_rendering()
    for axes in figure.axes:
        box = axes.get_tightbbox()
        assert box is not None
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1
