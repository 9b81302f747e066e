"""The legend of a map has the colours of its palette, and what the map shows."""

from __future__ import annotations

import re
from typing import Any

import pytest

from app.views.maps.map_legend import LegendContents, map_legend
from engine import CASES, Fate, MapSpec, Plane, parse_formula
from engine.systems.outcomes import Centre
from plots.pictures.palette import COLOUR_BLIND_SAFE, PAPER, Entry, Palette
from plots.pictures.time_scale import TimeScale
from tests.disc import DISC

PATCH = re.compile(r"--colour:(#[0-9a-f]+)'>([^<]*)")
ALL = frozenset(int(fate) for fate in (Fate.BOUNDED, Fate.FORBIDDEN, Fate.OUTSIDE, Fate.NOT_COMPUTED, 1, 2))


def contents(**changes: Any) -> LegendContents:
    spec = MapSpec(CASES["II"], Plane.X_PX, 0.2)
    values: dict[str, Any] = {"palette": PAPER, "times": TimeScale(2.5, 100.0), "locked": False, "regularity": "", "fates": ALL}
    return LegendContents(spec, **(values | changes))


def entries(html: str) -> list[tuple[str, str]]:
    """Label and colour of each entry."""
    return [(label.replace("&gt;", ">"), colour) for colour, label in PATCH.findall(html)]


@pytest.mark.parametrize("palette", [PAPER, COLOUR_BLIND_SAFE], ids=lambda palette: palette.name)
def test_exits_and_outcomes_have_the_colours_of_the_palette(palette: Palette) -> None:
    colours = dict(entries(map_legend("basins", contents(palette=palette), [])))
    assert [colours[str(k)] for k in (1, 2, 3)] == list(palette.channels[:3])
    words = {Fate.BOUNDED: "bounded", Fate.FORBIDDEN: "forbidden", Fate.OUTSIDE: "outside", Fate.NOT_COMPUTED: "not decided yet"}
    assert {colours[word] == palette.outcomes[fate].colour for fate, word in words.items()} == {True}


def test_only_outcomes_that_the_map_has_are_named_and_short_labels_have_the_whole_ones_as_titles() -> None:
    labels = [label for label, _ in entries(map_legend("basins", contents(fates=frozenset({int(Fate.BOUNDED)})), []))]
    assert labels == ["1", "2", "3", "bounded"]
    html = map_legend("basins", contents(), [])
    assert f"title='{PAPER.outcomes[Fate.FORBIDDEN].label}'" in html
    assert "title='channel 2'" in html


def test_crossings_have_their_classes_and_what_is_drawn_over_them() -> None:
    expected = [(entry.label, entry.colour) for entry in PAPER.crossing_entries]
    assert entries(map_legend("crossings", contents(), [])) == expected
    assert ("doubtful pixels", "#123456") in entries(map_legend("crossings", contents(), [Entry("doubtful pixels", "#123456")]))


def test_the_scale_has_both_ends_and_says_whether_it_is_locked() -> None:
    html = map_legend("times", contents(times=TimeScale(2.5, 1234.0)), [])
    assert "≤ 2.5 " in html
    assert "≥ 1 234" in html
    assert PAPER.escape_time[0] in html
    assert PAPER.escape_time[-1] in html
    assert "locked" not in html
    assert "locked" in map_legend("times", contents(locked=True), [])


def test_layers_have_legends_of_their_own() -> None:
    html = map_legend("characters", contents(regularity="1 % are chaotic."), [])
    assert "bounded and chaotic" in html
    assert "1 % are chaotic." in html
    assert "Enters by" in map_legend("origins", contents(), [])


def test_a_collision_has_its_label_and_colour() -> None:
    of_disc = LegendContents(MapSpec(DISC, Plane.X_PX, 0.19), PAPER, TimeScale(2.5, 100.0), False, "", ALL)
    assert ("collision with a disc", PAPER.of_kinds["collision"][0]) in entries(map_legend("basins", of_disc, []))
    assert "<th scope=col>collision with a disc</th>" in map_legend("origins", of_disc, [])


def test_the_name_of_a_centre_is_text() -> None:
    named = parse_formula("½(x² + y²) − xy²").with_outcomes([Centre(0.2, 0.3, 0.05, "<b>'")])
    of_disc = LegendContents(MapSpec(named, Plane.X_PX, 0.19), PAPER, TimeScale(2.5, 100.0), False, "", ALL)
    assert not any("<b>" in map_legend(picture, of_disc, []) for picture in ("basins", "origins"))
