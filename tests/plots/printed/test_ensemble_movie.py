"""Movies of orbits have a frame for each time in each format, and show the orbits that are still inside."""

from __future__ import annotations

import subprocess
from io import BytesIO
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

from engine import CASES, sample_orbits, sample_starts
from engine.results import SampledOrbits
from plots.pictures.palette import PAPER
from plots.printed.ensemble_movie import FRAMES_PER_SECOND, make_ensemble_movie
from plots.printed.figure_style import FigureStyle, MovieFormat

III, FRAMES = CASES["III"], 5
SMALL = FigureStyle(width=10.0, dpi=60.0)


@pytest.fixture(scope="module")
def orbits() -> SampledOrbits:
    return sample_orbits(III, sample_starts(III, 0.45, 300, rng=1), np.linspace(0.0, 12.0, FRAMES))


@pytest.mark.parametrize("format", [MovieFormat.WEBP, MovieFormat.GIF])
def test_there_is_a_frame_for_each_time(format: MovieFormat, orbits: SampledOrbits) -> None:
    with Image.open(BytesIO(make_ensemble_movie(III, orbits, PAPER, format, SMALL))) as movie:
        assert movie.n_frames == FRAMES
        movie.load()
        assert movie.width == pytest.approx(SMALL.inches * SMALL.dpi, abs=1)
        assert movie.info["duration"] == 1000 // FRAMES_PER_SECOND


def test_an_mp4_film_has_the_frames(orbits: SampledOrbits, tmp_path: Path) -> None:
    film = tmp_path / "film.mp4"
    film.write_bytes(make_ensemble_movie(III, orbits, PAPER, MovieFormat.MP4, SMALL))
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(film), "-f", "framecrc", "-"]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert sum(line.startswith("0,") for line in listed.splitlines()) == FRAMES


def test_particles_vanish_when_they_have_left(orbits: SampledOrbits) -> None:
    with Image.open(BytesIO(make_ensemble_movie(III, orbits, PAPER, MovieFormat.GIF, SMALL))) as movie:
        coloured = []
        for frame in (0, FRAMES - 1):
            movie.seek(frame)
            pixels = np.asarray(movie.convert("RGB"), int)
            left = pixels[:, : pixels.shape[1] // 2]
            coloured.append(int((np.ptp(left, axis=2) > 60).sum()))
    assert np.isfinite(orbits.x[:, -1]).mean() < 0.5
    assert coloured[1] < coloured[0]
