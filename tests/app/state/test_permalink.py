"""Links restore the view state, and invalid links give messages."""

from __future__ import annotations

from urllib.parse import parse_qsl

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.state.permalink import linked_view, read_link, without_system, write_link
from app.state.view import PICTURES, Analysis, View
from app.state.view_state import ViewState
from app.state.watched_starts import COUNTS, StartsFrom, WatchedStarts
from engine import CASES, Coordinate, ParameterAxis, Plane, Slice, System, Window, read_section
from engine.systems.system import TYPED
from plots.layers.table import LAYERS
from plots.links.map_link import LONGEST_VALUE
from plots.links.map_view import RESOLUTION_CHOICES, SETTINGS, T_MAX_CHOICES
from plots.pictures.palette import MOST_ORBITS, PALETTES
from plots.pictures.time_scale import TimeScale
from tests.app.state.opened_link import open_link
from tests.engine.slices.test_slice import slices

numbers = st.floats(-1e3, 1e3, allow_nan=False)
pairs = st.tuples(numbers, numbers).filter(lambda pair: pair[0] < pair[1])
windows = st.none() | st.builds(lambda x, y: Window(*x, *y), pairs, pairs)


def parameters(link: str) -> dict[str, str]:
    assert link.startswith("?")
    return dict(parse_qsl(link[1:], strict_parsing=True))


@given(
    st.sampled_from(list(CASES)),
    st.sampled_from(list(Plane)) | slices(),
    st.floats(1e-3, 1e3),
    st.sampled_from(list(T_MAX_CHOICES.values())),
    st.sampled_from(list(RESOLUTION_CHOICES.values())),
    windows,
    windows,
    st.lists(st.tuples(numbers, numbers), max_size=MOST_ORBITS).map(tuple),
    st.frozensets(st.sampled_from(list(LAYERS))),
    st.sampled_from(Analysis),
    st.sampled_from(list(PALETTES)),
    st.integers(0, MOST_ORBITS - 1),
    st.fixed_dictionaries({name: st.sampled_from(list(one.choices.values())) for name, one in SETTINGS.items()}),
    st.sampled_from([None, TimeScale(0.5, 2000.0)]),
)
def test_a_link_contains_the_view_state_at_full_precision(
    case, plane, energy, t_max, resolution, window, box, starts, layers, analysis, palette, look, settings, lock_times
) -> None:
    chosen = {
        "system": System(case), "plane": plane, "energy": energy, "t_max": t_max, "resolution": resolution,
        "window": window, "box": box, "starts": starts, "analysis": analysis, "palette": palette,
        "settings": settings, "lock_times": lock_times, "layers": layers,
        "chosen": look if look < len(starts) else 0,
    }  # fmt: skip
    values, problems = read_link(parameters(write_link(ViewState(**chosen))))
    assert not problems
    again = ViewState(**values)
    assert {name: getattr(again, name) for name in chosen} == chosen


@pytest.mark.parametrize("focus", PICTURES)
def test_an_embedded_picture_is_read_as_the_large_picture(focus: str) -> None:
    values, problems = read_link(parameters(write_link(ViewState(focus=focus), embedded=True)))
    assert (values["focus"], problems) == (focus, [])


def test_an_embedded_picture_of_a_layer_has_its_layer() -> None:
    assert read_link({"embed": "characters"})[0] == {"focus": "characters", "layers": {"judge"}}
    assert read_link({"embed": "origins", "origins": "no"})[0] == {"focus": "origins", "layers": {"origins"}}


INVALID = {
    "case": ["IV", "__class__"],
    "embed": ["all"],
    "plane": ["(x, px)", "x,z", "x,epsilon=3:1"],
    "fix": ["y=0.1"],
    "h": ["nan", "1e999", "one", "1" * (LONGEST_VALUE + 1)],
    "t_max": ["1e300", "7"],
    "resolution": ["225", "100000"],
    "window": ["1,2,3", "1,0,0,1", "0,inf,0,1"],
    "box": ["1,0,0,1"],
    "orbits": ["0.1", "0.1,0.2;0.3", ";".join(["0.1,0.2"] * (MOST_ORBITS + 1)), "<script>alert(1)</script>"],
    "palette": ["neon"],
    "look": ["6"],
    "judge": ["maybe"],
    "analysis": ["all"],
    "images": ["4", "0"],
    "lock_times": ["1", "nan", "9,2", "1,2,3"],
    "watch": ["well", "moon,5000,1,-2", "well,7,1,-2", "well,5000,-1,-2", "well,5000,1,5"],
}


@pytest.mark.parametrize(("name", "text"), [(name, text) for name, texts in INVALID.items() for text in texts])
def test_an_invalid_value_is_named_and_ignored(name: str, text: str) -> None:
    values, problems = read_link({name: text})
    assert values == {}
    assert len(problems) == 1
    assert problems[0].startswith(f"Ignored {name}")
    assert ": choose " in problems[0]
    assert "nan" not in problems[0]


def test_an_energy_that_the_system_does_not_have_is_named_with_what_is_legal() -> None:
    assert open_link({"case": "III", "h": "-5"})[1] == ["Ignored h=-5: choose an energy above 0, such as 0.35."]


def test_a_jacobi_constant_stands_for_the_energy_of_a_rotating_system() -> None:
    state, problems = open_link({"case": "Hill", "C": "4"})
    assert (state.energy, problems) == (-2.0, [])
    state, problems = open_link({"case": "II", "C": "4"})
    assert state.energy == state.energies.first
    assert problems == ["Ignored C=4: the frame of this system does not rotate."]


@pytest.mark.parametrize("text", ["100000", "1e5", "1E+5", "100000.0", "100 000", "100,000", "100\u202f000"])
def test_any_usual_format_of_a_number_is_read(text: str) -> None:
    assert read_link({"t_max": text}) == ({"t_max": 1e5}, [])


def test_an_invalid_potential_drops_the_parameters_that_depend_on_it() -> None:
    state, problems = open_link({"V": "x²", "box": "0,1,0,1", "window": "0,1,0,1", "h": "0.3", "resolution": "112"})
    assert (state.system.case, state.box, state.window, state.energy, state.resolution) == ("I", None, None, 0.19, 112)
    assert len(problems) == 1
    assert problems[0].startswith("Ignored the potential in the link: ")


def test_a_missing_chosen_orbit_is_the_first() -> None:
    assert read_link({"orbits": "0.1,0.2", "look": "3"})[0]["chosen"] == 0


@pytest.mark.parametrize("energy", ["low", "first"])
def test_a_link_may_have_each_energy_of_the_range_of_a_body_beside_the_origin(energy: str) -> None:
    body = {"V": "−6/√((x−2.28)²+(y−0.08)²); centre B0 (2.28, 0.08) 0.001; escape 10", "rotation": "1"}
    energies = open_link(body)[0].energies
    value = getattr(energies, energy)
    state, problems = open_link({**body, "h": repr(value)})
    assert value < state.potential.value(0.0, 0.0)
    assert (state.energy, problems) == (value, [])
    lower = energies.low - 1.0
    _, problems = open_link({**body, "h": repr(lower)})
    assert problems == [f"Ignored h={lower:.6g}: choose an energy above {energies.low:.6g}, such as {energies.first:.6g}."]


def test_a_case_without_an_energy_has_its_initial_energy() -> None:
    assert open_link({"case": "III"})[0].energy == 0.35


def test_a_system_whose_bounded_orbits_are_all_integrated_has_a_short_time_unless_the_link_has_one() -> None:
    assert open_link({"case": "Copenhagen"})[0].t_max == 1e3
    assert open_link({"case": "Copenhagen", "t_max": "1e4"})[0].t_max == 1e4
    assert open_link({"case": "III"})[0].t_max == 1e5


def test_a_link_is_read_without_a_review() -> None:
    values, problems = read_link({"V": "no formula", "h": "-5", "t_max": "1e3"})
    assert (values, problems) == ({"system": System(TYPED, "no formula"), "energy": -5.0, "t_max": 1e3}, [])
    assert linked_view(values) == View(System(TYPED, "no formula"), energy=-5.0, t_max=1e3)


def test_unknown_parameters_are_ignored() -> None:
    assert read_link({"utm_source": "mail"}) == ({}, [])


def test_a_slice_along_a_letter_belongs_to_the_system_of_the_link() -> None:
    link = {"case": "typed", "V": "0.5(x^2+y^2) - a x y^2", "letters": "a:1.5", "plane": "x,a=1:2", "fix": "px=0.1"}
    values, problems = read_link(link)
    system = System("typed", link["V"], {"a": 1.5})
    assert problems == []
    axis = ParameterAxis("a", 1.0, 2.0, system)
    assert values["plane"] == Slice(Coordinate.X, axis, fixed=((Coordinate.PX, 0.1),))
    assert "plane" not in without_system(values)


@pytest.mark.parametrize("formula", ["a x^2 +", "a x^2 + log(y)", "a" + "/(x - 1)" * 40])
def test_a_slice_along_a_letter_is_read_without_its_potential(formula: str) -> None:
    values, problems = read_link({"V": formula, "plane": "x,a=1:2"})
    assert (values["plane"].parameter.system.formula, problems) == (formula, [])


COMPARED = [
    View(System("II", "", {"epsilon": 1.25}), Plane.X_PX, 0.1 + 0.2),
    View(System(TYPED, "½(x²+y²) − a x y²", {"a": 1.5}), Slice(Coordinate.X, Coordinate.THETA), 0.2),
    View(System("III"), Plane.X_H, 0.25),
    View(System("II"), section=read_section("angle = 30° down")),
    View(System("II")),
]


@pytest.mark.parametrize("view", COMPARED, ids=lambda view: view.title)
def test_a_link_contains_the_view_with_which_another_is_compared(view: View) -> None:
    values, problems = read_link(parameters(write_link(ViewState(system=System("I"), energy=0.2, compared=view))))
    assert (values["compared"], problems) == (view, [])


@pytest.mark.parametrize(
    ("link", "named"),
    [
        ({"with_case": "II", "with_h": "1e300"}, ["with_h=1e300"]),
        ({"with_case": "V", "with_plane": "x,x", "with_h": "nan"}, ["with_case=V", "with_h", "with_plane=x,x"]),
        ({"with_V": "x" * 501, "with_h": "0.2"}, ["with_V=xxx"]),
    ],
)
def test_an_invalid_view_to_compare_with_is_left_out_and_each_invalid_part_is_named(
    link: dict[str, str], named: list[str]
) -> None:
    values, problems = read_link(link)
    assert "compared" not in values
    for name, problem in zip(named, sorted(problems), strict=True):
        assert problem.startswith(f"Ignored {name}")


def test_both_ends_of_an_axis_h_may_be_named() -> None:
    values, problems = read_link({"with_case": "III", "with_plane": "x_h", "with_h": "0.25,0.7"})
    assert (values["compared"], problems) == (View(System("III"), Plane.X_H, 0.25), [])


@given(st.sampled_from(StartsFrom), st.sampled_from(COUNTS), st.integers(0, 2**31 - 1), st.integers(-18, -2))
def test_a_link_contains_the_starts_that_are_watched(where: StartsFrom, count: int, seed: int, radius: int) -> None:
    watched = WatchedStarts(where, count, seed, radius / 2)
    values, problems = read_link(parameters(write_link(ViewState(watched=watched))))
    assert (values.get("watched", WatchedStarts()), problems) == (watched, [])


def test_a_single_number_is_the_upper_end_of_the_scale() -> None:
    assert read_link({"lock_times": "2000"}) == ({"lock_times": TimeScale(1.0, 2000.0)}, [])


def test_a_link_contains_a_section_and_refuses_others() -> None:
    state = ViewState(section=read_section("pericentre about (0.5, 0)"))
    values, problems = read_link(parameters(write_link(state)))
    assert values["section"] == state.section
    assert not problems
    values, problems = read_link({"section": "nowhere"})
    assert "section" not in values
    assert "apsis" in problems[0]


def test_the_first_section_is_not_in_links() -> None:
    assert "section" not in parameters(write_link(ViewState()))
