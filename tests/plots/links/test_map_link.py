"""The map of a link is that of its parameters."""

from __future__ import annotations

import pytest

from engine import Plane, System, Window, read_section
from engine.systems.review.potential_review import review_system
from engine.systems.system import TYPED
from plots.links.map_link import read_map_view
from plots.links.map_view import MapView
from plots.links.presets import PRESETS


def test_a_link_has_the_values_of_the_map() -> None:
    link = (
        "case=typed&V=½(x²%2By²)-a x y²&letters=a:1.5&plane=y_py&h=0.1&section=x%3D0+up&t_max=1000&resolution=112"
        "&window=-1,1,-0.5,0.5&orbits=0.1,0.2;0.3,0&trust=yes&analysis=measures"
    )
    view = read_map_view(link)
    assert view == MapView(
        System(TYPED, "½(x²+y²)-a x y²", {"a": 1.5}), Plane.Y_PY, 0.1, 1e3, 112, Window(-1.0, 1.0, -0.5, 0.5),
        frozenset({"trust"}), section=read_section("x = 0 up"), starts=((0.1, 0.2), (0.3, 0.0)),
    )  # fmt: skip


def test_along_an_axis_h_the_map_has_the_energies_of_the_system() -> None:
    view = read_map_view("case=II&plane=x_h")
    low, high = view.map_spec(review_system(view.system)).energy  # type: ignore[misc]
    assert (low, high) == (pytest.approx(1.0 / 6.0), 0.5)


@pytest.mark.parametrize(
    ("link", "message"),
    [
        ("case=IX", "case=IX: choose I, II"),
        ("plane=x_z", r"plane=x\?z: choose"),
        ("t_max=5", "t_max=5: choose 100"),
        ("resolution=113", "choose 112, 224, 450 or 900"),
        ("orbits=1,2,3", "choose up to 5 starts"),
        ("V=x²&letters=a:1", "choose omega_1, omega_2, epsilon, rotation."),
        ("case=Earth-Moon&epsilon=2", "parameters that the system does not have: choose m."),
        ("case=Hill&rotation=2", "leave them out"),
    ],
)
def test_illegal_values_are_refused(link: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read_map_view(link)


def test_the_links_of_all_presets_are_legal() -> None:
    assert all(preset.map_view.starts or "analysis=watch" in preset.link for preset in PRESETS)
