"""Legends list the fates that occur on their own map."""

from __future__ import annotations

from dataclasses import replace

from engine import CASES, MapSpec, Plane, compute_map
from plots.layers.escapes import COMPARED
from plots.layers.picture import OtherView, ShownMap, occurring_fates
from plots.pictures.palette import PAPER


def test_the_legend_of_the_other_view_lists_the_fates_of_its_map() -> None:
    open_map, closed_map = (compute_map(MapSpec(CASES["I"], Plane.X_PX, h, (12, 12), t_max=50.0)) for h in (0.5, 0.1))
    spec, shown = closed_map.spec, ShownMap.of(open_map, PAPER, {})
    assert "bounded" not in [entry.label for entry in shown.outcome_entries().values()]
    other = OtherView("Case I, h = 0.1", spec.outcomes, spec.plane.axis_symbols, occurring_fates(closed_map))
    labels = [entry.label for entry in COMPARED.legend(replace(shown, other=other)).others]
    assert "bounded" in labels
    assert not any(label.startswith("outside") for label in labels)
