"""A live figure is one file with the map, the engine and the words of the explorer, and it allows no request."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from engine import CASES, POTENTIALS, EscapeMap, MapSpec, Plane, Potential, System, compute_map, review_potential
from engine.slices.slice_text import read_slice
from engine.systems.outcomes import Centre
from plots.layers.map_images import picture_pixels
from plots.live.live_figure import live_figure
from plots.live.live_view import LIVE_PICTURES, LiveView, live_refusal
from plots.pictures.palette import DEFAULT_COLOURS


@pytest.fixture(scope="module")
def found() -> EscapeMap:
    return compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.45, (40, 30), t_max=200.0))


@pytest.fixture(scope="module")
def page(found: EscapeMap) -> str:
    link = "https://explorer.example/?a=1&b=2"
    view = LiveView(found.spec, (0.3, 0.6), [(0.1, 0.05)], "times", "x < 1 & y > 2", link)
    return live_figure(view, found)


def data_of(page: str) -> dict[str, Any]:
    [text] = re.findall(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)
    data: dict[str, Any] = json.loads(text)
    return data


def test_the_pictures_are_those_of_the_map(found: EscapeMap, page: str) -> None:
    pictures = data_of(page)["pictures"]
    assert [picture["name"] for picture in pictures] == ["times", "basins", "crossings"]
    for picture in pictures:
        content = base64.b64decode(picture["image"].removeprefix("data:image/png;base64,"))
        pixels = np.asarray(Image.open(BytesIO(content)).convert("RGBA"))
        np.testing.assert_array_equal(pixels, picture_pixels(found, picture["name"], DEFAULT_COLOURS))


def test_the_view_is_that_of_the_map(found: EscapeMap, page: str) -> None:
    data = data_of(page)
    window = found.spec.find_window()
    assert list(data["window"].values()) == list(window.edges)
    assert (data["energy"], data["low"], data["high"]) == (0.45, 0.3, 0.6)
    assert data["starts"] == [[0.1, 0.05]]
    assert data["labels"] == [outcome.label for outcome in found.outcomes]


def test_a_negative_energy_has_a_minus_sign() -> None:
    spec = MapSpec(POTENTIALS["Hill"], Plane.X_PX, -2.0, (4, 4), t_max=1.0)
    page = live_figure(LiveView(spec), compute_map(spec))
    assert '<output id="shown-energy">−2.0' in page
    assert data_of(page)["energy"] == -2.0


def test_the_policy_allows_the_script_of_the_file_and_no_request(page: str) -> None:
    [script] = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    [policy] = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page)
    assert f"'sha256-{digest}'" in policy
    assert policy.startswith("default-src 'none';")
    assert "http" not in policy


def test_the_file_refers_to_nothing_but_the_link(page: str) -> None:
    assert set(re.findall(r"https?://[^\"'\s<]+", page)) <= {
        "https://explorer.example/?a=1&amp;b=2",
        "http://www.w3.org/2000/svg",
    }
    assert "x &lt; 1 &amp; y &gt; 2" in page


@pytest.mark.parametrize("picture", LIVE_PICTURES)
def test_a_live_figure_has_at_most_400_kilobytes(picture: str) -> None:
    found = compute_map(MapSpec(POTENTIALS["C5"], Plane.X_PX, 0.5, (224, 224), t_max=100.0))
    assert len(live_figure(LiveView(found.spec, picture=picture), found).encode()) < 400_000


def test_a_map_and_its_request_write_the_same_live_figure(found: EscapeMap, tmp_path: Path) -> None:
    for name, shown in (("map", found), ("request", found.spec)):
        shown.to_html(tmp_path / name, energies=(0.3, 0.6), palette="safe")
    assert data_of((tmp_path / "map").read_text())["high"] == 0.6
    assert (tmp_path / "map").read_bytes() == (tmp_path / "request").read_bytes()


@pytest.mark.parametrize(
    ("potential", "energy", "energies"),
    [
        (POTENTIALS["Star cluster"], -1.75, (-3.0, -0.9)),
        (POTENTIALS["III"], 1.2, (0.2, 1.2)),
        (POTENTIALS["III"].in_rotating_frame(0.1), 0.3, None),
    ],
)
def test_the_energies_are_those_of_the_catalogue_or_else_of_the_review(
    potential: Potential, energy: float, energies: tuple[float, float] | None
) -> None:
    review = review_potential(potential)
    found = LiveView(MapSpec(potential, Plane.X_PX, energy)).find_energies()
    assert found == (energies or (review.energies.low, review.energies.high))


def test_words_that_look_like_markup_stay_in_the_data(tmp_path: Path) -> None:
    potential = CASES["I"].with_outcomes([Centre(0.0, 0.0, 0.05, "a <!-- </script> b")], 3.0)
    MapSpec(potential, Plane.X_PX, 0.1, (4, 4), t_max=5.0).to_html(tmp_path / "figure.html")
    assert "a <!-- </script> b" in data_of((tmp_path / "figure.html").read_text())["labels"][0]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"energies": (0.5, 0.6)}, "energies="),
        ({"energies": (0.6, 0.3)}, "energies="),
        ({"energies": (0.3, np.inf)}, "energies"),
        ({"starts": [(0.0, 0.0)] * 6}, "starts: there are 6; must be at most 5"),
        ({"starts": [(np.nan, 0.0)]}, "starts"),
        ({"picture": "curves"}, "picture='curves': must be one of basins, times, crossings"),
        ({"palette": "blue"}, "palette="),
        ({"link": "javascript:alert(1)"}, "link="),
    ],
)
def test_illegal_options_are_refused(found: EscapeMap, tmp_path: Path, options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        found.to_html(tmp_path / "figure.html", **options)
    assert not (tmp_path / "figure.html").exists()


def test_a_slice_along_a_parameter_has_no_live_figure() -> None:
    plane = read_slice("x,epsilon=0.5:2", "", System("I"))
    assert "along ε each orbit belongs to another system" in live_refusal(MapSpec(CASES["I"], plane, 0.2))
    assert live_refusal(MapSpec(CASES["I"], Plane.X_PX, 0.2)) == ""
