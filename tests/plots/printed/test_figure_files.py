"""Files of figures are the same bytes each time, with text, provenance and the requested width."""

from __future__ import annotations

import re
from collections.abc import Callable
from io import BytesIO

import pytest
from PIL import Image

from engine import (
    CASES,
    EscapeMap,
    MapSpec,
    Plane,
    SweepSpec,
    compute_map,
    compute_sweep,
    integrate_orbit,
)
from engine.measures.table import curve_names
from plots.pictures.orbit_curves import compute_orbit_curves
from plots.pictures.palette import PAPER
from plots.pictures.setting import NO_SETTINGS
from plots.printed.figure_axes import MOST_PIXELS
from plots.printed.figure_files import map_figure_bytes, orbits_figure_bytes, study_figure_bytes
from plots.printed.figure_style import CM_PER_INCH, FigureFormat, FigureStyle
from plots.studies.against import AGAINST

NARROW = FigureStyle(8.5, dpi=100.0)
Draw = Callable[[FigureFormat, FigureStyle], bytes]


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.18, (20, 15), window=(-1.0, 1.4, -0.8, 0.8), t_max=200.0))


def draw_orbits(format: FigureFormat, style: FigureStyle) -> bytes:
    states = ((0.1, 0.0, 0.05, 0.6), (0.1, 0.0, 0.05, 0.3))
    orbits = [compute_orbit_curves(CASES["I"], integrate_orbit(CASES["I"], state, 100.0)) for state in states]
    return orbits_figure_bytes(CASES["I"], orbits, PAPER, ["regular", "chaotic"], format, style)


def draw_curves(format: FigureFormat, style: FigureStyle) -> bytes:
    sweep = compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, (0.2, 0.3), (12, 12), t_max=100.0, measures=curve_names()))
    return study_figure_bytes(AGAINST, sweep, NO_SETTINGS, format, style)


@pytest.fixture(
    scope="module", params=["maps", *(pytest.param(each, marks=pytest.mark.slow) for each in (draw_orbits, draw_curves))]
)
def draw(request: pytest.FixtureRequest, escape_map: EscapeMap) -> Draw:
    """Return a function that draws one of the figures."""
    if callable(request.param):
        return request.param  # type: ignore[no-any-return]
    return lambda format, style: map_figure_bytes(escape_map, ["basins", "times"], PAPER, format, style)


@pytest.fixture(scope="module")
def narrow(draw: Draw) -> dict[FigureFormat, bytes]:
    """Return the file of a narrow figure in each format."""
    return {format: draw(format, NARROW) for format in FigureFormat}


@pytest.mark.parametrize("format", FigureFormat)
def test_files_are_the_same_each_time(format: FigureFormat, draw: Draw, narrow: dict[FigureFormat, bytes]) -> None:
    assert draw(format, NARROW) == narrow[format]


def test_files_have_the_given_width(narrow: dict[FigureFormat, bytes]) -> None:
    with Image.open(BytesIO(narrow[FigureFormat.PNG])) as image:
        assert image.width == int(8.5 / CM_PER_INCH * 100.0)
        assert image.info["dpi"] == pytest.approx((100.0, 100.0), abs=0.1)
    points = re.search(rb'<svg [^>]*width="([0-9.]+)pt"', narrow[FigureFormat.SVG])
    assert points is not None
    assert float(points[1]) == pytest.approx(8.5 / CM_PER_INCH * 72.0, abs=1e-3)
    box = re.search(rb"/MediaBox \[ ?0 0 ([0-9.]+)", narrow[FigureFormat.PDF])
    assert box is not None
    assert float(box[1]) == pytest.approx(8.5 / CM_PER_INCH * 72.0, abs=1e-3)


def test_text_stays_text_in_svg_files_and_nothing_has_a_date(narrow: dict[FigureFormat, bytes]) -> None:
    svg = narrow[FigureFormat.SVG].decode()
    assert svg.count("<text") > 10
    assert "STIXGeneral" in svg
    assert "dc:date" not in svg
    assert b"CreationDate" not in narrow[FigureFormat.PDF]


def test_pixels_of_a_map_are_embedded_as_they_are(escape_map: EscapeMap) -> None:
    svg = map_figure_bytes(escape_map, ["basins"], PAPER, FigureFormat.SVG, NARROW).decode()
    image = re.search(r"<image [^>]*>", svg)
    assert image is not None
    assert 'width="20" height="15"' in image[0]
    assert "pixelated" in image[0]
    pdf = map_figure_bytes(escape_map, ["basins"], PAPER, FigureFormat.PDF, NARROW)
    assert b"/Width 20" in pdf
    assert b"/Height 15" in pdf


def test_a_png_has_a_field_for_each_fact(escape_map: EscapeMap) -> None:
    with Image.open(BytesIO(map_figure_bytes(escape_map, ["basins"], PAPER, FigureFormat.PNG, NARROW))) as image:
        notes = image.info
    assert notes["Software"].startswith("escape-explorer ")
    assert {name: notes[name] for name in escape_map.provenance()} == {k: str(v) for k, v in escape_map.provenance().items()}


def test_a_png_with_too_many_pixels_is_refused_and_the_same_figure_as_svg_is_not(escape_map: EscapeMap) -> None:
    dpi = 1200
    large = FigureStyle(100.0, dpi)
    with pytest.raises(ValueError, match=rf"dpi={dpi}: must be at most \d+ for a figure of 100 × \d+ cm") as caught:
        map_figure_bytes(escape_map, ["basins"], PAPER, FigureFormat.PNG, large)
    most = int(re.findall(r"at most (\d+)", str(caught.value))[0])
    assert (most * 100.0 / CM_PER_INCH) ** 2 <= MOST_PIXELS
    assert map_figure_bytes(escape_map, ["basins"], PAPER, FigureFormat.SVG, large)


def test_a_figure_without_pictures_or_orbits_is_refused(escape_map: EscapeMap) -> None:
    with pytest.raises(ValueError, match=r"pictures=\[\]: must be at least one of curves"):
        map_figure_bytes(escape_map, [], PAPER, FigureFormat.PNG, NARROW)
    with pytest.raises(ValueError, match=r"orbits=\[\]: must be at least one"):
        orbits_figure_bytes(CASES["I"], [], PAPER, [], FigureFormat.PNG, NARROW)


@pytest.mark.parametrize("format", FigureFormat)
def test_files_contain_their_provenance(format: FigureFormat, escape_map: EscapeMap) -> None:
    data = map_figure_bytes(escape_map, ["basins"], PAPER, format, FigureStyle(titles=False))
    assert b"escape-explorer" in data
    assert b"Taylor series" in data
