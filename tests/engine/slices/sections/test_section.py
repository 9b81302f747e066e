"""Sections: their words, their slices of starts, their coordinates, and their mirror images."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, POTENTIALS, Plane, Potential, Section, read_section, sample_orbits
from engine.slices.planes import checked_slice
from engine.slices.sections.section import Crossing
from engine.systems.catalogue.table import CATALOGUE

WORDS = {
    "y = 0": ("upward crossings of y = 0", "1 upward crossing of y = 0", "Crossings of y = 0"),
    "x = 0.1 both": ("crossings of x = 0.1", "1 crossing of x = 0.1", "Crossings of x = 0.1"),
    "x = -0.1 both": ("crossings of x = −0.1", "1 crossing of x = −0.1", "Crossings of x = −0.1"),
    "apsis about (-0.5, 0)": ("apsides about (−0.5, 0)", "1 apsis about (−0.5, 0)", "Apsides about (−0.5, 0)"),
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
    states = section.slice_of_starts.states(potential, 0.15, x, ordinate)
    assert np.isfinite(states).all()
    form, motion = section.form, np.column_stack([states[:, 2:], -np.stack(potential.gradient(*states[:, :2].T), axis=1)])
    coefficients = np.array([form.get(name, 0.0) for name in ("x", "y", "px", "py")])
    np.testing.assert_allclose(states @ coefficients, form.get("value", 0.0), atol=1e-15)
    sign = -1.0 if section.direction is Crossing.DOWN else 1.0
    # An oblique slice has all signs of the other momentum, and some starts then cross in the other direction.
    leaves = sign * (motion @ coefficients) > 0.0
    assert leaves.all() if section.is_drawn_on(section.slice_of_starts) else leaves.mean() > 0.5


def test_sections_of_coordinates_are_drawn_on_their_slices() -> None:
    assert Section.Y_UP.plane is Plane.X_PX
    assert read_section("x = 0, px > 0").plane == Plane.Y_PY
    texts = {"y = 0.2": True, "px = 0": True, "py = 0.1": True, "apsis": True, "angle = 30°": False, "px + py = 0": False}
    for text, is_drawn in texts.items():
        section = read_section(text)
        # A slice in a link is the equal plane, if there is one.
        assert section.is_drawn_on(checked_slice(section.slice_of_starts)) == is_drawn
    assert not Section.Y_UP.is_drawn_on(Plane.Y_PY)


@pytest.mark.parametrize("text", ["x + 0.3 px = 0", "px + py = 0", "pericentre about (0.5, 0)"])
def test_a_section_without_a_slice_of_its_starts_has_none(text: str) -> None:
    section = read_section(text)
    assert (section.plane, section.slice_of_starts) == (None, Plane.X_PX)
    assert section.find_start(CASES["II"], np.array([0.1, 0.0, 0.0, 0.3])) is None


@pytest.mark.parametrize("text", [*ON_SECTION, "x + y = 0 both", "px = 0.02 both", "py = 0", "pericentre", "apsis", "apocentre"])
def test_every_state_on_a_section_is_a_start_of_one_of_its_slices(text: str) -> None:
    section, rng = read_section(text), np.random.default_rng(3)
    states = rng.uniform(-0.2, 0.2, (20, 4))
    # The states are moved onto the section along the gradient of its form, to both sides of it.
    for _ in range(8):
        gradients = np.stack([section.rates(states, np.broadcast_to(unit, states.shape)) for unit in np.eye(4)], axis=-1)
        states = states - (section.values(states) / np.sum(gradients**2, axis=-1))[:, None] * gradients
    for state in states:
        found = section.find_start(CASES["II"], state)
        assert found is not None
        plane, place = found
        (start,) = plane.states(CASES["II"], float(CASES["II"].energy(state)), *np.array(place)[:, None])
        np.testing.assert_allclose(start, state, atol=1e-9)


@pytest.mark.parametrize("potential", [CASES["II"], POTENTIALS["Hill"]])
@pytest.mark.parametrize("text", ["x - 2y + px = 0.1 down", "apocentre about (0.2, -0.1)"])
def test_rates_are_those_of_the_values_along_an_orbit(potential: Potential, text: str) -> None:
    section, step = read_section(text), 1e-6
    states = sample_orbits(potential, [[0.3, 0.1, 0.2, -0.3]], [1.0 - step, 1.0, 1.0 + step])
    before, state, after = np.column_stack([states.x[0], states.y[0], states.px[0], states.py[0]])
    expected = (section.values(after) - section.values(before)) / (2.0 * step)
    np.testing.assert_allclose(section.rates(state, potential.derivatives(state)), expected, rtol=1e-6)


def test_lengths_far_beyond_the_well_are_legal_in_its_units() -> None:
    for text in ("x = 5e8", "apsis about (5e8, 0)"):
        scaled = read_section(text).in_well_units(POTENTIALS["Earth-Moon"].units)
        assert max(map(abs, scaled.form.values())) > 1e9


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


@pytest.mark.parametrize("name", ["Hill", "Earth-Moon"])
def test_sections_of_the_catalogue_pass_through_the_libration_points(name: str) -> None:
    sections = [read_section(text) for text in CATALOGUE[name].sections if text.startswith("x = ")]
    for x, y in POTENTIALS[name].saddles:
        assert min(abs(section.values(np.array([x, y, 0.0, 0.0]))) for section in sections) < 1e-12


def test_sections_of_the_catalogue_can_be_read() -> None:
    sections = [read_section(text) for entry in CATALOGUE.values() for text in entry.sections]
    assert len(sections) > 5
