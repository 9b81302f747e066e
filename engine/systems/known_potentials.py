"""The potentials of the catalogue by name."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from engine.foundations.names import ByName
from engine.systems.catalogue.table import CATALOGUE, PAPER_ENERGIES
from engine.systems.potential import Potential
from engine.systems.system import System


@cache
def _make_potential(name: str) -> Potential:
    return System(name).potential


CASES: Mapping[str, Potential] = ByName("case", PAPER_ENERGIES, _make_potential)
"""The three cases of Zotos (2014): V = (x² + y²)/2 + V1 with V1 = −x y², −x (x²/3 − y²) and −x² y²."""

POTENTIALS: Mapping[str, Potential] = ByName("potential", CATALOGUE, _make_potential, lambda name: CATALOGUE[name].title)
"""All potentials of the catalogue, by name: ``POTENTIALS["HH"]``. The three cases of Zotos (2014) come first."""
