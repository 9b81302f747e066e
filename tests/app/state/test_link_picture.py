"""What the picture of a link shows: the map of its view, small and short."""

from __future__ import annotations

from urllib.parse import parse_qsl, urlencode

import pytest

from app.state.link_picture import LONGEST_TIME, SIDE, LinkPicture, picture_of
from app.state.permalink import read_link
from engine import CASES, MapSpec, Plane
from engine.potentials.catalogue.table import PAPER_ENERGIES
from engine.potentials.review.potential_review import review_system


def picture(link: str) -> LinkPicture:
    values, problems = read_link(dict(parse_qsl(link)))
    assert problems == []
    return picture_of(values)


def spec(link: str) -> MapSpec:
    shown = picture(link)
    return shown.map_spec(review_system(shown.system))


def test_the_map_is_that_of_the_view_at_its_own_resolution() -> None:
    shown = spec("case=III&plane=x_y&h=0.4&t_max=100&resolution=900&window=-1,1,-0.5,0.5")
    assert shown == MapSpec(CASES["III"], Plane.X_Y, 0.4, (SIDE, SIDE), (-1.0, 1.0, -0.5, 0.5), 100.0)


def test_a_link_without_energy_shows_the_first_one_of_its_system() -> None:
    assert spec("case=II").energy == PAPER_ENERGIES["II"].first


def test_an_axis_of_energies_has_those_of_the_page() -> None:
    low, high = spec("case=II&plane=x_h").energy
    assert (low, high) == pytest.approx((1 / 6, review_system(picture("case=II").system).energies.high))


@pytest.mark.parametrize(
    ("formula", "title"),
    [
        ("½r² − a x²y exp(−y²)", "Typed potential, V = ½r² − a x²y exp(−y²)"),
        ("−1/r; centre the Moon (0, 0) 0.0045", "Typed potential, V = −1/r"),
        ("x + " * 19 + "x²y", "Typed potential, V = " + "x + " * 19 + "x²y"),
        ("x + " * 20 + "x²y", "Typed potential"),
        ("visit http://elsewhere.example", "Typed potential"),
        ("x²; centre elsewhere", "Typed potential, V = x²"),
    ],
)
def test_the_title_has_a_short_formula_and_no_other_text(formula: str, title: str) -> None:
    assert picture(urlencode({"V": formula})).title == title


def test_links_that_differ_in_orbits_and_layers_have_one_picture() -> None:
    assert picture("case=II&h=0.2&orbits=0.1,0.2&judge=yes&resolution=450&box=0,1,0,1") == picture("case=II&h=0.2")


def test_the_time_is_limited_in_units_of_the_well() -> None:
    plain, fast = "½(x² + y²) − x²y + y³/3", "128(x² + y²) − x²y + y³/3"
    assert spec(f"V={plain.replace('+', '%2B')}&t_max=1000000").t_max == LONGEST_TIME
    # 16 times as fast.
    assert spec(f"V={fast.replace('+', '%2B')}&t_max=1000000&h=100").t_max == LONGEST_TIME / 16.0


@pytest.mark.parametrize(
    ("link", "problem"),
    [("V=x^2/2%2By^2/2", "No saddle"), ("case=I&h=-3", "h=-3"), ("V=x^2/2%2B", "formula")],
    ids=["no exit", "energy below the well", "no formula"],
)
def test_invalid_views_are_refused_with_a_reason(link: str, problem: str) -> None:
    with pytest.raises(ValueError, match=problem):
        spec(link)


@pytest.mark.parametrize(
    ("link", "begin"),
    [
        ("case=III&h=0.45&plane=x_y", "Case III on the plane (x, y) at h = 0.45: "),
        ("case=II&h=0.2&plane=x_h", "Case II on the plane (x, h): "),
        ("case=HH&omega_1=1.1", "Hénon–Heiles with ω1 = 1.1 on the plane (x, px): "),
        ("V=x^2-y^4&h=1", "Typed potential, V = x^2-y^4 on the plane (x, px) at h = 1: "),
    ],
)
def test_the_sentence_names_system_plane_and_energy(link: str, begin: str) -> None:
    assert picture(link).describe().startswith(begin)
