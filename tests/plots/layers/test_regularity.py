"""Regular and chaotic orbits have different colours, before and after they are judged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine import CASES, EscapeMap, Evidence, Fate, MapSpec, Plane, Regularity, compute_map, compute_regularity
from engine.results import RegularityMap
from plots.layers.map_images import layer_columns, result_columns
from plots.layers.picture import ShownMap
from plots.layers.regularity import CODES, REGULARITY
from plots.layers.table import map_legend
from plots.pictures.palette import PAPER


def colour_of(character: Regularity) -> str:
    (colour,) = {code.entry(PAPER).colour for code in CODES if code.code is character}
    return colour


def painted(frame: EscapeMap, regularity: RegularityMap | None = None) -> np.ndarray:
    """Return the colours of the pixels of the layer."""
    assert REGULARITY.pixels is not None
    known = layer_columns(frame, {"judge"}) if regularity is None else result_columns("judge", frame, regularity)
    return np.array(REGULARITY.pixels.colours(PAPER))[known["character"][0]]


def test_regular_and_chaotic_orbits_have_different_colours() -> None:
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.15, (25, 25), t_max=2000.0))
    regularity = compute_regularity(whole)
    colours = painted(whole, regularity)
    for character in (Regularity.REGULAR, Regularity.CHAOTIC, Regularity.NO_SIGN_OF_CHAOS):
        assert character in regularity.character
        assert set(colours[regularity.character == character]) == {colour_of(character)}
    assert set(colours[whole.fate == Fate.FORBIDDEN]) == {PAPER.outcomes[Fate.FORBIDDEN].colour}


def test_the_legend_has_orbits_that_are_not_judged_while_there_may_be_some() -> None:
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.15, (8, 8), t_max=20.0))
    found = compute_regularity(frame)
    labels = []
    for result in (None, replace(found, complete=False), found):
        legend = map_legend("characters", ShownMap.of(frame, PAPER, {} if result is None else {"judge": result}))
        labels.append([entry.label for entry in legend.entries])
    (unjudged,) = {code.entry(PAPER).label for code in CODES if code.code is Regularity.NOT_JUDGED}
    assert [unjudged in each for each in labels] == [True, True, False]


def test_orbits_on_tori_are_regular_before_they_are_judged() -> None:
    whole = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.28, (41, 41), t_max=1e4))
    colours = painted(whole)
    tori = whole.evidence == Evidence.QUASI_PERIODIC
    assert tori.any()
    assert set(colours[tori]) == {colour_of(Regularity.REGULAR)}
    assert set(colours[whole.evidence == Evidence.ENCLOSED]) == {colour_of(Regularity.NOT_JUDGED)}
    assert set(colours[whole.fate >= 1]) == {colour_of(Regularity.NOT_APPLICABLE)}
