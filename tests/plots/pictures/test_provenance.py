"""A line of text tells how a map was made."""

from __future__ import annotations

from dataclasses import replace

import pytest

from engine import POTENTIALS, MapSpec, Plane, Window, compute_map, read_section
from plots.pictures.provenance import provenance_line


def line_of(name: str, energy: float, window: Window | None = None, rotation: float | None = None) -> str:
    potential = POTENTIALS[name] if rotation is None else POTENTIALS[name].in_rotating_frame(rotation)
    return provenance_line(compute_map(MapSpec(potential, Plane.X_PX, energy, (3, 3), window, t_max=1.0)))


def test_a_rotating_frame_and_bodies_are_named() -> None:
    assert ", Ω = 0.2, h = 0.15, " in line_of("I", 0.15, rotation=0.2)
    assert "disc of radius " in line_of("Copenhagen", -1.7)
    assert "Ω" not in line_of("I", 0.15)


def test_a_section_other_than_the_default_is_named() -> None:
    spec = MapSpec(POTENTIALS["I"], Plane.X_PX, 0.15, (3, 3), t_max=1.0)
    texts = ["y = 0 up", "x = 0 up", "x = 0 both"]
    lines = [provenance_line(compute_map(replace(spec, section=read_section(text)))) for text in texts]
    assert [text in line for text, line in zip(texts, lines, strict=True)] == [False, True, True]


@pytest.mark.parametrize(
    ("window", "ends"),
    [(Window(-0.25, 0.5, -0.1, 0.1), "x from −0.25 to 0.5"), (Window(0.12, 0.12 + 1e-9, 0, 0.1), "x from 0.12 to 0.120000001")],
)
def test_ends_of_the_window_have_as_many_digits_as_it_needs(window: Window, ends: str) -> None:
    assert ends in line_of("I", 0.15, window)
