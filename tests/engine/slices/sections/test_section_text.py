"""Sections are written as text and read again."""

from __future__ import annotations

import math
from typing import Any

import pytest

from engine import Section, read_section
from engine.slices.sections.central_sections import ApsisSection, RaySection
from engine.slices.sections.linear_section import LinearSection
from engine.slices.sections.section import Crossing
from engine.slices.sections.section_text import checked_section

LEGAL = {
    "y = 0": Section.Y_UP,
    "y=0, py > 0": Section.Y_UP,
    "x = 0, px > 0": LinearSection(x=1.0),
    "x = 0, px < 0": LinearSection(Crossing.DOWN, x=1.0),
    "y = 0.1 both": LinearSection(Crossing.BOTH, y=1.0, value=0.1),
    "X = −2e-3 UPWARD": LinearSection(x=1.0, value=-2e-3),
    "px = 0.25 down": LinearSection(Crossing.DOWN, px=1.0, value=0.25),
    "2x - y + 0.5 py = 1": LinearSection(x=2.0, y=-1.0, py=0.5, value=1.0),
    "-x + 3*px = -.5, down": LinearSection(Crossing.DOWN, x=-1.0, px=3.0, value=-0.5),
    "x + x = 1": LinearSection(x=2.0, value=1.0),
    "angle = 30°": RaySection(degrees=30.0),
    "theta = -45 clockwise": RaySection(Crossing.DOWN, -45.0),
    "angle = 90° about (0.5, -1) both": RaySection(Crossing.BOTH, 90.0, (0.5, -1.0)),
    "apsis": ApsisSection(Crossing.BOTH),
    "apsis inward": ApsisSection(Crossing.DOWN),
    "pericentre": ApsisSection(Crossing.UP),
    "apocentre about (0.25, 0)": ApsisSection(Crossing.DOWN, (0.25, 0.0)),
    "periapsis about (-0, 0)": ApsisSection(Crossing.UP),
}
ILLEGAL = (
    "", "y", "y = ", "= 0", "z = 0", "x y = 0", "x = 0 sideways", "x = 0, py > 0", "x + y = 0, px > 0", "x = 1 + 1", "x = nan",
    "0 x = 0", "angle = north", "angle = 400", "apsis about 3", "pericentre = 0", "x = 1e12", "y = 0, px > 1", "y = 0 up down",
    "pericentre down", "apocentre both", "angle = 30, px > 0", "apsis, px > 0", "x = 0 clockwise", "y = 0 inward",
    "1e-9 x = 1e9", "1e-320 x = 1", "1e-200 x + 1e-200 y = 0",
)  # fmt: skip


@pytest.mark.parametrize("text", LEGAL)
def test_a_text_gives_a_section_that_is_written_as_an_equal_section(text: str) -> None:
    section = read_section(text)
    assert section == LEGAL[text]
    assert read_section(section.text) == section


@pytest.mark.parametrize("value", [1.0 / 3.0, 1e-300, -math.pi, 123456789.0, 5e-324])
def test_numbers_are_written_with_all_their_digits(value: float) -> None:
    for section in (LinearSection(x=value, y=1.0, value=value), ApsisSection(centre=(value, -value))):
        assert read_section(section.text) == section


@pytest.mark.parametrize("text", ["y = -0", "angle = -0", "apsis about (-0, 0)"])
def test_a_section_has_no_negative_zero(text: str) -> None:
    section = read_section(text)
    assert "-0" not in repr(section) + section.text


@pytest.mark.parametrize("text", ILLEGAL)
def test_other_texts_are_refused_in_one_sentence(text: str) -> None:
    with pytest.raises(ValueError, match="section") as raised:
        read_section(text)
    assert "must" in str(raised.value)


@pytest.mark.parametrize("value", [None, 3, Section(), ("y", 0)])
def test_values_that_are_no_section_are_refused(value: Any) -> None:
    for read in (checked_section, read_section):
        with pytest.raises(ValueError, match="section="):
            read(value)


def test_wrong_numbers_are_refused() -> None:
    for make in (
        lambda: LinearSection(),
        lambda: LinearSection(x=math.inf),
        lambda: LinearSection("up", x=1.0),  # type: ignore[arg-type]
        lambda: RaySection(degrees=math.nan),
        lambda: ApsisSection(centre=(1.0,)),  # type: ignore[arg-type]
    ):
        with pytest.raises(ValueError, match=r"section|direction"):
            make()
