"""The legend has the colours of the palette, and what the map shows."""

from __future__ import annotations

import re

import pytest

from app.views.maps.map_legend import MapLegend
from engine import CASES, Fate, MapSpec, Plane
from plots.palette import COLOUR_BLIND_SAFE, PAPER, Entry, Palette

PATCH = re.compile(r"--colour:(#[0-9a-f]+)'>([^<]+)")


def entries(legend: MapLegend) -> list[tuple[str, str]]:
    """Label and colour of each entry."""
    return [(label.replace("&gt;", ">"), colour) for colour, label in PATCH.findall(legend.pane.object)]


@pytest.mark.parametrize("palette", [PAPER, COLOUR_BLIND_SAFE], ids=lambda palette: palette.name)
def test_the_entries_are_those_of_the_palette(palette: Palette) -> None:
    legend = MapLegend()
    curve = Entry("limiting curve", "#1b1b1b")
    legend.show(MapSpec(CASES["II"], Plane.X_PX, 0.2), palette, 100.0, [curve])
    outcomes = [palette.outcomes[fate] for fate in (Fate.BOUNDED, Fate.FORBIDDEN, Fate.OUTSIDE, Fate.NOT_COMPUTED)]
    expected = [*palette.channel_entries(3), *palette.crossing_entries, *outcomes, curve]
    assert sorted(entries(legend)) == sorted((entry.label, entry.colour) for entry in expected)
    assert palette.escape_time[0] in legend.pane.object
    assert palette.escape_time[-1] in legend.pane.object


def test_the_scale_ends_at_the_longest_time() -> None:
    legend = MapLegend()
    legend.show(MapSpec(CASES["I"], Plane.X_PX, 0.2), PAPER, 1234.0, [])
    assert "≥ 1 234" in legend.pane.object


def test_the_scale_begins_at_the_shortest_time_and_says_whether_it_is_locked() -> None:
    legend = MapLegend()
    legend.show(MapSpec(CASES["I"], Plane.X_PX, 0.2), PAPER, 100.0, [], locked=True)
    assert "≤ 1 " in legend.pane.object
    assert "locked" in legend.pane.object


def test_layers_have_entries_only_while_they_are_shown() -> None:
    legend, spec = MapLegend(), MapSpec(CASES["I"], Plane.X_PX, 0.2)
    legend.show(spec, PAPER, 100.0, [])
    assert "chaotic" not in legend.pane.object
    assert "Enters by" not in legend.pane.object
    legend.show(spec, PAPER, 100.0, [], regularity="1 % are chaotic.", origins=True)
    assert "bounded and chaotic" in legend.pane.object
    assert "1 % are chaotic." in legend.pane.object
    assert "Enters by" in legend.pane.object
