"""Sections: their words, their slices of starts, their coordinates, and their mirror images."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, POTENTIALS, Plane, Section, read_section
from engine.slices.sections.section import Crossing
from engine.systems.catalogue.table import CATALOGUE

WORDS = {
    "y = 0": ("upward crossings of y = 0", "1 upward crossing of y = 0", "Crossings of y = 0"),
    "x = 0.1 both": ("crossings of x = 0.1", "1 crossing of x = 0.1", "Crossings of x = 0.1"),
    "angle = 30°": (
        "counterclockwise crossings of the ray at 30°",
        "1 counterclockwise crossing of the ray at 30°",
        "Crossings of the ray at 30°",
    ),
    "apsis": ("apsides", "1 apsis", "Apsides"),
    "apocentre about (0.5, 0)": ("apocentres about (0.5, 0)", "1 apocentre about (0.5, 0)", "Apocentres about (0.5, 0)"),
}
# Sections on which starts lie exactly, with the directions in which they leave.
ON_SECTION = (
    "y = 0",
    "y = 0.1 down",
    "x = 0, px > 0",
    "x = -0.05 down",
    "2x = 0.2",
    "x - 2y = 0.1",
    "x + y = 0 down",
    "angle = 40°",
)
MIRRORED = ("y = 0", "y = 0.1 down", "py = 0 both", "x = 0 both", "apsis", "pericentre", "angle = 90° both")
NOT_MIRRORED = ("x = 0", "x = 0.1 both", "angle = 30°", "angle = 90°", "x + y = 0", "apsis about (0.1, 0)", "px = 0")


@pytest.mark.parametrize("text", WORDS)
def test_crossings_have_the_words_of_the_field(text: str) -> None:
    section = read_section(text)
    assert (section.crossings_name, section.count(1), section.words.title) == WORDS[text]


def test_the_default_section_needs_no_numbers() -> None:
    for units in (CASES["I"].units, POTENTIALS["Barred galaxy"].units):
        assert Section.Y_UP.in_well_units(units).numbers == ((None), ())
    assert read_section("2y = 0").numbers.rows


@pytest.mark.parametrize("text", ON_SECTION)
def test_starts_of_its_slice_are_on_a_section_and_leave_it_in_its_direction(text: str) -> None:
    section, potential = read_section(text), CASES["II"]
    x, ordinate = np.random.default_rng(1).uniform(0.01, 0.2, (2, 50))
    states = section.plane.states(potential, 0.15, x, ordinate)
    assert np.isfinite(states).all()
    form, motion = section.form, np.column_stack([states[:, 2:], -np.stack(potential.gradient(*states[:, :2].T), axis=1)])
    coefficients = np.array([form.get(name, 0.0) for name in ("x", "y", "px", "py")])
    np.testing.assert_allclose(states @ coefficients, form.get("value", 0.0), atol=1e-15)
    sign = -1.0 if section.direction is Crossing.DOWN else 1.0
    # An oblique slice has all signs of the other momentum, and some starts then cross in the other direction.
    leaves = sign * (motion @ coefficients) > 0.0
    assert leaves.all() if section.is_drawn_on(section.plane) else leaves.mean() > 0.5


def test_sections_of_coordinates_are_drawn_on_their_slices() -> None:
    assert Section.Y_UP.plane is Plane.X_PX
    assert read_section("x = 0, px > 0").plane == Plane.Y_PY
    drawn = {text: read_section(text).is_drawn_on(read_section(text).plane) for text in ("y = 0.2", "px = 0", "angle = 30°")}
    assert drawn == {"y = 0.2": True, "px = 0": True, "angle = 30°": False}
    assert not Section.Y_UP.is_drawn_on(Plane.Y_PY)


def test_points_have_the_coordinates_of_the_section() -> None:
    state = np.array([0.3, 0.4, 1.0, 2.0])
    along = np.array([0.6, 0.8])
    np.testing.assert_allclose(Section.Y_UP.axes.points(state), [0.3, 1.0])
    ray = read_section("angle = 53.13010235415598° about (0.3, 0)")
    np.testing.assert_allclose(ray.axes.points(state), [along @ [0.0, 0.4], along @ [1.0, 2.0]])
    line = read_section("0.8x - 0.6y = 0")
    np.testing.assert_allclose(line.axes.points(state), [along @ state[:2], along @ state[2:]])


def test_quarter_turns_are_exact() -> None:
    for degrees, ends in ((0, (1.0, 0.0)), (90, (0.0, 1.0)), (-180, (-1.0, 0.0)), (270, (0.0, -1.0))):
        form = read_section(f"angle = {degrees}°").form
        assert (form["side_x"], form["side_y"]) == ends


@pytest.mark.parametrize("text", [*MIRRORED, *NOT_MIRRORED])
def test_only_symmetric_sections_have_the_same_crossings_on_mirror_images(text: str) -> None:
    assert read_section(text).is_mirrored == (text in MIRRORED)


def test_sections_of_the_catalogue_can_be_read() -> None:
    sections = [read_section(text) for entry in CATALOGUE.values() for text in entry.sections]
    assert len(sections) > 5
