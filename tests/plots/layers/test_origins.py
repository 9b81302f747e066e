"""The colour of a pixel shows where its orbit came from and where it goes."""

from __future__ import annotations

import numpy as np

from engine import CASES, Fate, MapSpec, Plane, compute_origin_fates
from plots.layers.origins import ORIGINS, passage_colour
from plots.pictures.palette import PAPER


def test_a_passage_has_the_colour_of_its_origin_and_exit() -> None:
    origins = compute_origin_fates(MapSpec(CASES["III"], Plane.X_PX, 0.3, (45, 45), t_max=200.0))
    assert ORIGINS.pixels is not None
    colours = np.array(ORIGINS.pixels.colours(PAPER))[ORIGINS.pixels.codes(origins, None)]
    seen = 0
    for origin in range(5):
        for fate in range(5):
            where = (origins.origin == origin) & (origins.fate == fate)
            assert set(colours[where]) <= {passage_colour(PAPER, origin, fate)}
            seen += int(where.sum())
    sentences = np.array(ORIGINS.pixels.columns(origins, None)["passage_words"][0])[ORIGINS.pixels.codes(origins, None)]
    assert set(sentences[(origins.origin == 2) & (origins.fate >= 0)]) == {"entered through exit 2"}
    assert set(sentences[(origins.origin == 0) & (origins.fate >= 0)]) == {"never entered: inside since −t_max"}
    assert seen == np.sum(origins.fate >= 0)
    assert set(colours[origins.fate == Fate.FORBIDDEN]) == {PAPER.outcomes[Fate.FORBIDDEN].colour}
