"""A link has a title and a sentence for other programs."""

from __future__ import annotations

from urllib.parse import parse_qsl, urlencode

import pytest

from app.session.page import link_sentence, link_title
from app.state.permalink import linked_view, read_link
from app.state.view import View


def view(link: str) -> View:
    values, problems = read_link(dict(parse_qsl(link)))
    assert problems == []
    return linked_view(values)


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
    assert link_title(view(urlencode({"V": formula}))) == title


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
    assert link_sentence(view(link)).startswith(begin)
