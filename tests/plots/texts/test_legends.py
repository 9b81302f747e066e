"""The legend of a map names its outcomes and layers, in the colours of the palette."""

from __future__ import annotations

import re
from typing import Any

from engine import CASES, Fate, MapSpec, Plane, Potential, parse_formula
from engine.systems.outcomes import Centre
from plots.layers.origins import passage_colour
from plots.layers.picture import OtherView, ShownMap
from plots.layers.table import map_legend
from plots.layers.trust import TONES
from plots.pictures.palette import PAPER
from plots.pictures.time_scale import TimeScale
from plots.texts.legends import picture_legend
from tests.results import result_of

PATCH = re.compile(r"--colour:(#[0-9a-f]+)'>([^<]*)")
ALL = frozenset(int(fate) for fate in (Fate.BOUNDED, Fate.FORBIDDEN, Fate.OUTSIDE, Fate.NOT_COMPUTED, 1, 2))


def legend(picture: str, potential: Potential = CASES["II"], **changes: Any) -> str:
    """Return the HTML of the legend of a picture."""
    values: dict[str, Any] = {"palette": PAPER, "times": TimeScale(2.5, 100.0), "fates": ALL}
    return picture_legend(map_legend(picture, ShownMap(MapSpec(potential, Plane.X_PX, 0.19), **(values | changes))))


def entries(html: str) -> list[tuple[str, str]]:
    """Return the label and colour of each entry."""
    return [(label.replace("&gt;", ">"), colour) for colour, label in PATCH.findall(html)]


def test_the_title_of_the_other_view_follows_all_colours_of_its_map() -> None:
    potential = CASES["I"]
    html = legend("compared", other=OtherView("Case I, (x, px), h = 0.3", potential.outcomes, Plane.X_PX.axis_symbols, ALL))
    assert [label for label, _ in entries(html)] == ["1", "2", "bounded", "forbidden", "outside", "not decided yet"]
    assert html.endswith("<span>Case I, (x, p<sub>x</sub>), h\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}0.3</span>")


def test_legends_name_only_outcomes_of_the_map_and_short_labels_have_the_whole_labels_as_titles() -> None:
    labels = [label for label, _ in entries(legend("basins", fates=frozenset({int(Fate.BOUNDED)})))]
    assert labels == ["1", "2", "3", "bounded"]
    html = legend("basins")
    assert f"title='{PAPER.outcomes[Fate.FORBIDDEN].label}'" in html
    assert "title='exit 2'" in html


def test_the_legend_of_crossings_has_their_classes_and_the_layers_over_them() -> None:
    expected = [(entry.short_label, entry.colour) for entry in PAPER.crossing_entries]
    assert entries(legend("crossings")) == expected
    html = legend("crossings", results={"trust": None})
    assert "title='doubtful pixels'" in html
    assert all(tone in html for tone in TONES)
    both = legend("crossings", CASES["III"], results={"manifolds": result_of("manifolds"), "trust": None})
    assert "doubtful" in both
    assert [both.count(f"stable manifold {k}") for k in (1, 2)] == [1, 1]
    assert both.count(">manifolds<") + both.count(";manifolds<") == 1


def test_the_scale_has_both_ends_and_says_whether_it_is_locked() -> None:
    html = legend("times", times=TimeScale(2.5, 1234.0))
    assert "≤ 2.5 " in html
    assert "≥ 1 234" in html
    assert PAPER.escape_time[0] in html
    assert PAPER.escape_time[-1] in html
    assert "locked" not in html
    assert "locked" in legend("times", is_locked=True)


def test_each_exit_has_a_tone_for_each_origin() -> None:
    ends = ("1", "2", "3", "bounded")
    tones = re.findall("title='from (.*?) to (.*?)' style='--colour:(.*?)'", legend("origins"))
    numbers = {end: number for number, end in enumerate(ends, 1)} | {"bounded": 0}
    assert tones == [(origin, end, passage_colour(PAPER, numbers[origin], numbers[end])) for end in ends for origin in ends]
    assert "tones: from 1, 2, 3, bounded" in legend("origins")


def test_the_name_of_a_centre_is_text() -> None:
    named = parse_formula("½(x² + y²) − xy²").with_outcomes([Centre(0.2, 0.3, 0.05, "<b>'")])
    assert not any("<b>" in legend(picture, named) for picture in ("basins", "origins"))
