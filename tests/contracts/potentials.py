"""The potentials of the contract tests: the catalogue, and some random ones."""

from __future__ import annotations

import numpy as np
import pytest

from engine.potentials.catalogue import POTENTIALS
from engine.potentials.formula_parser import write_formula
from engine.potentials.potential import Potential
from engine.potentials.validation_report import review_potential

# Compiling kernels takes long, so normal runs do it for one potential of the catalogue, and exhaustive runs for all. The three
# cases of the paper are covered by other tests.
MARKS = {"C5": (), "C8": (pytest.mark.slow,)}


def _random(seed: int) -> Potential:
    """A well with random terms of degree 3 and 4: the first one for this seed that the review accepts."""
    rng = np.random.default_rng(seed)
    while True:
        powers = [(i, n - i) for n in (3, 4) for i in range(n + 1)]
        chosen = rng.choice(len(powers), 3, replace=False)
        terms = tuple((*powers[k], float(np.round(rng.normal(), 3))) for k in chosen)
        frequencies = ((2, 0, float(np.round(rng.uniform(0.3, 1.0), 3))), (0, 2, float(np.round(rng.uniform(0.3, 1.0), 3))))
        potential = Potential(f"random {seed}", (*frequencies, *terms))
        review = review_potential(potential)
        if review.refusal is None and not any("other wells" in remark for remark in review.remarks):
            return Potential(write_formula(potential), potential.terms)


RANDOM = tuple(_random(seed) for seed in range(3))
ALL = (*(entry.potential for entry in POTENTIALS.values()), *RANDOM)

each_potential = pytest.mark.parametrize("potential", ALL, ids=lambda potential: potential.name)
each_compiled = pytest.mark.parametrize(
    "potential",
    [pytest.param(p, marks=MARKS.get(p.name, pytest.mark.exhaustive)) for p in ALL],
    ids=lambda potential: potential.name,
)
