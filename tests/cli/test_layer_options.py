"""Options of layers are checked before the map is computed."""

from __future__ import annotations

import pytest

from cli.layer_options import read_layers
from engine import CASES, POTENTIALS, MapSpec, Plane

ORDINARY = MapSpec(CASES["I"], Plane.X_PX, 0.3)
AROUND_BODIES = MapSpec(POTENTIALS["Copenhagen"], Plane.X_PX, -1.6)


@pytest.mark.parametrize(
    ("spec", "values", "sentence"),
    [
        (ORDINARY, {"descriptor_power": 3.0}, "power=3.0: must be above 0 and at most 1$"),
        (ORDINARY, {"descriptor_time": -1.0}, "duration=-1"),
        (AROUND_BODIES, {"judge": True}, "does not tell regular from chaotic"),
        (AROUND_BODIES, {"manifolds": 2}, "escape at a circle"),
        (MapSpec(CASES["I"], Plane.X_Y, 0.3), {"manifolds": 2}, "is not such a slice"),
        (MapSpec(POTENTIALS["HH"], Plane.X_H, (0.1, 0.3)), {"periodic": 2}, "is not such a slice"),
    ],
)
def test_a_layer_that_a_map_cannot_have_is_refused(spec: MapSpec, values: dict, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        read_layers(**{"descriptor": True, **values}).check(spec)
