"""The picture of a link: its size, the pixels of its map, its title and its well."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from engine import CASES, EscapeMap, MapSpec, Plane, compute_map
from plots.link_picture import HEIGHT, draw_link_picture, link_picture_bytes
from plots.map_images import picture_pixels
from plots.palette import PAPER, rgba

SIDE = 70


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.3, (SIDE, SIDE), (-0.2, 0.2, -0.2, 0.2), 50.0))


@pytest.fixture(scope="module")
def image(escape_map: EscapeMap) -> np.ndarray:
    return np.array(Image.open(BytesIO(link_picture_bytes(escape_map, "Case II", PAPER))).convert("RGBA"))


def texts(escape_map: EscapeMap, title: str) -> str:
    return "\n".join(text.get_text() for text in draw_link_picture(escape_map, title, PAPER).texts)


def test_each_start_is_a_square_of_its_colour(escape_map: EscapeMap, image: np.ndarray) -> None:
    scale = HEIGHT // SIDE
    # This window has no limiting curve.
    whole = picture_pixels(escape_map, "basins", PAPER).repeat(scale, axis=0).repeat(scale, axis=1)
    assert np.array_equal(image[:, :HEIGHT], whole)


def test_the_well_shows_all_exits(image: np.ndarray) -> None:
    beside = {tuple(colour) for colour in image[:, HEIGHT:].reshape(-1, 4)}
    assert {tuple(colour) for colour in rgba(PAPER.channels[:3])} <= beside


def test_the_text_names_system_plane_energy_and_time(escape_map: EscapeMap) -> None:
    assert texts(escape_map, "Case II") == (
        "Case II\n(x, px) at h = 0.3\nColoured: the exit of the orbit. Grey: none up to t = 50."
    )
