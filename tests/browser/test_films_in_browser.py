"""Films of the pictures can be played by other programs, and show what moves."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import imageio_ffmpeg
import numpy as np
from playwright.sync_api import expect

from plots.pictures.palette import DEFAULT_COLOURS
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

OpenExplorer = Callable[..., ExplorerPage]
FILM = "● Film"
# Largest difference of a compressed colour, per channel.
COLOUR_ERROR = 24
# Side of the frames that are compared, and number of pixels that are more than an error of the encoder.
SIDE, FEW_PIXELS = 600, 40
# Number of frames that are compared, per second.
RATE = 3


def film_of(explorer: ExplorerPage, button: int, folder: Path) -> tuple[str, np.ndarray]:
    """Press a button, and return the name of the film and its frames as an array of shape (frames, SIDE, SIDE, 3)."""
    with explorer.page.expect_download() as download:
        explorer.button(FILM).nth(button).click()
    path = folder / download.value.suggested_filename
    download.value.save_as(path)
    form = ["-vf", f"fps={RATE},scale={SIDE}:{SIDE}", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(path), *form, "-"]
    pixels = np.frombuffer(subprocess.run(command, capture_output=True, check=True).stdout, np.uint8)
    return path.name, pixels.reshape(-1, SIDE, SIDE, 3).astype(np.int16)


def assert_moving(frames: np.ndarray) -> None:
    """Check that there are several pictures with the colours of the exits, and that the last differs from the first."""
    assert len(frames) >= 3
    for colour in DEFAULT_COLOURS.channels[:2]:
        is_near = np.abs(frames - list(bytes.fromhex(colour[1:]))).max(axis=3) <= COLOUR_ERROR
        assert np.count_nonzero(is_near, axis=(1, 2)).max() > FEW_PIXELS
    assert np.count_nonzero(np.abs(frames[-1] - frames[0]).max(axis=2) > 2 * COLOUR_ERROR) > FEW_PIXELS


def test_a_film_of_the_energy_shows_the_maps_up_to_the_highest_energy(open_explorer: OpenExplorer, tmp_path: Path) -> None:
    explorer = open_explorer(1280, 800, QUICK.replace("h=0.19", "h=0.47"))
    name, frames = film_of(explorer, 0, tmp_path)
    assert name == "escapes-energy.webm"
    assert_moving(frames)
    # The animation ends as that of "Play".
    explorer.wait_for_view("h=0.5&")
    expect(explorer.button(FILM)).to_be_enabled()


def test_a_film_of_orbits_shows_how_they_leave(open_explorer: OpenExplorer, tmp_path: Path) -> None:
    explorer = open_explorer(1280, 800, f"{QUICK}&analysis=watch&watch=well,5000,1,-2")
    expect(explorer.page.get_by_role("button", name="Watch them leave")).to_be_enabled()
    explorer.page.get_by_label("Speed").select_option("fast")
    name, frames = film_of(explorer, 1, tmp_path)
    assert name == "escapes-orbits.webm"
    assert_moving(frames)
