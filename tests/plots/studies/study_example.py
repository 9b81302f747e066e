"""The study of the example in docs/extending.md."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from engine import Potential, Result, find_lyapunov_orbits
from engine.jobs.job import Job, Queue
from plots.pictures import charts
from plots.pictures.palette import Palette
from plots.pictures.setting import Settings
from plots.studies import axes
from plots.studies.study import Study
from tests.extending import run_example

_GIVEN: dict[str, Any] = {
    **{name: getattr(charts, name) for name in ("Chart", "Frame", "Series", "Shape")},
    **{name: getattr(axes, name) for name in ("ENERGY", "changes_at", "spaced_values")},
    **{one.__name__: one for one in (Job, Palette, Potential, Queue, Result, Study, dataclass, find_lyapunov_orbits)},
    "Settings": Settings, "Sequence": Sequence, "np": np, "__name__": __name__,
}  # fmt: skip


@cache
def study_of_periods() -> Study[Any]:
    """Return the entry of the example."""
    entry: Study[Any] = run_example("Example: add a study", _GIVEN)["PERIODS"]
    return entry
