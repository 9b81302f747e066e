"""Escape statistics against energy and number of crossings of y = 0 (Zotos 2014, section 5)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.dynamics.fates import Fate
from engine.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.maps.compute import run_map
from engine.maps.result import EscapeMap
from engine.maps.spec import DEFAULT_RESOLUTION, MapSpec
from engine.measures.escape_statistics import EscapeStatistics, compute_statistics
from engine.potentials.potential import Potential
from engine.results.codes import describe_codes
from engine.slices.slice import Slice
from engine.slices.window import GivenWindow, Window
from engine.sweeps.complete_map import require_complete
from engine.sweeps.curves import MOST_VALUES, CurvesSpec
from engine.sweeps.energy_grid import checked_sweep
from engine.validation import checked_count, checks_types

if TYPE_CHECKING:
    import xarray as xr

# More crossings than any orbit has by the largest t_max.
_MOST_CROSSINGS = 2**31 - 1
_WINDOW = tuple(Window.__dataclass_fields__)


@shows_progress("crossing statistics")
@checks_types(potential=Potential, execution=Execution)
def compute_crossing_statistics(
    potential: Potential,
    plane: Slice,
    energies: Sequence[float] | np.ndarray,
    resolution: tuple[int, int] = DEFAULT_RESOLUTION,
    t_max: float = 1e5,
    *,
    window: GivenWindow | None = None,
    count_outside: bool = False,
    most_crossings: int | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> xr.Dataset:
    """Compute a map at each energy and tabulate how many orbits escape after how many crossings.

    One map at a time is in memory.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        (x, y) or (x, px). The statistics of the paper are on (x, px), where all starts lie on y = 0.
    energies
        h, finite, dimensionless, 1 to 1000 of them; sorted and made unique.
    resolution
        (columns, rows) of each map.
    t_max
        Integration time, dimensionless, 0 < t_max ≤ 1e8.
    window
        Window of all maps, given as in `MapSpec`; None for the default window of each energy.
    count_outside, most_crossings
        As in `tabulate_crossing_statistics`.
    execution
        How the computation runs.

    Returns
    -------
    As `tabulate_crossing_statistics`.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When a parameter is out of its range, or no exit is defined at one of the energies.

    Examples
    --------
    >>> from escape_explorer import CASES, Plane, compute_crossing_statistics
    >>> table = compute_crossing_statistics(CASES["III"], Plane.X_PX, (0.4, 0.5, 0.6), (40, 40), t_max=1e3)
    >>> table["direct_share"].values.round(3)
    array([0.573, 0.786, 0.938])
    """
    _, values = checked_sweep(plane, energies, MOST_VALUES)
    sweep = CurvesSpec(potential, plane, values, resolution, t_max, exponent=False)
    specs = [replace(sweep.point(h).map_spec, window=window) if window else sweep.point(h).map_spec for h in sweep.values]
    _check_most_crossings(most_crossings)
    maps = _compute_maps(specs, execution)
    return tabulate_crossing_statistics(maps, count_outside=count_outside, most_crossings=most_crossings)


def tabulate_crossing_statistics(
    maps: Iterable[EscapeMap], *, count_outside: bool = False, most_crossings: int | None = None
) -> xr.Dataset:
    """Tabulate how many orbits escape after how many upward crossings of y = 0, from maps of ascending energy.

    Numbers of orbits: N0 starts, Ne escapes, Nde direct escapes (without a crossing), dN_n escapes after exactly n crossings,
    N_n orbits that have not escaped before the n-th crossing; the escape probability is p_n = dN_n / N_n (Zotos 2014, section 5,
    after Contopoulos, Harsoula & Lukes-Gerakopoulos 2012). The start itself is not a crossing, and only
    crossings before the escape count.

    Parameters
    ----------
    maps
        Complete maps on (x, y) or (x, px) that differ only in energy and window, by ascending energy; consumed one by one.
    count_outside
        Whether to include starts outside in N0, as escapes at t = 0 through the channel they lie in, without a crossing. The
        percentages of the paper are of this kind. They depend on the windows; those of the interior do not.
    most_crossings
        Largest n of the table, 0 or more; None for the largest that occurs, often thousands.

    Returns
    -------
    Dataset, dimensionless throughout, with coordinates `h` (m,), `n` (0, 1, …) and `fate` (bounded, then outcomes 1, 2, …):

    - `starts`, `escaped`, `direct`, `failed` (h): N0, Ne, Nde and the orbits whose integration failed, int64.
    - `escaped_share`, `direct_share` (h): Ne/N0, Nde/N0; NaN if N0 is 0.
    - `share` (h, fate): shares of N0; their sum is 1 if none failed.
    - `crossing_count`, `crossing_share` (h, n): dN_n and dN_n/N0.
    - `remaining` (h, n): N_n without failed orbits, so that it tends to the number of bounded ones.
    - `escape_probability` (h, n): p_n; NaN if N_n is 0.
    - `mean_escape_time`, `median_escape_time` (h): over the escaping orbits; NaN if there are none.
    - `worst_energy_error` (h), and `window` (h, edge).

    Its attributes are the provenance of the maps.

    Raises
    ------
    ValueError
        When there are no maps, one is incomplete, is on (x, h) or differs from the first in more than energy and window, energies
        do not ascend, or `most_crossings` is negative.
    """
    _check_most_crossings(most_crossings)
    rows: list[_Row] = []
    for frame in maps:
        _check_next(frame, rows[-1].spec if rows else None)
        rows.append(_count(frame, count_outside))
    if not rows:
        raise ValueError("maps: none given; must be one or more")
    return _tabulate(rows, most_crossings).assign_attrs(_provenance(rows[0].spec, count_outside))


@dataclass(frozen=True, eq=False)
class _Row:
    """Statistics of one map."""

    spec: MapSpec
    statistics: EscapeStatistics
    worst_energy_error: float


def _compute_maps(specs: Sequence[MapSpec], execution: Execution) -> Iterator[EscapeMap]:
    for index, spec in enumerate(specs):
        yield require_complete(run_map(spec, execution.part(index, len(specs))))


def _check_most_crossings(most_crossings: int | None) -> None:
    if most_crossings is not None:
        checked_count("most_crossings", most_crossings, 0, _MOST_CROSSINGS)


def _check_next(frame: EscapeMap, last: MapSpec | None) -> None:
    spec = frame.spec
    spec.plane.check_one_potential("maps")
    if spec.common_energy is None:
        raise ValueError(f"maps: one is on {spec.plane.title}; must be on a slice without an axis h")
    if not frame.complete:
        raise ValueError(f"maps: the map at h={spec.energy} is not complete, {frame.undecided:.2%} of its starts are undecided")
    if last is None:
        return
    if replace(spec, energy=last.energy, window=last.window) != last:
        raise ValueError(f"maps: {spec} differs from {last}; all but energy and window must be equal")
    if last.common_energy is not None and spec.common_energy <= last.common_energy:
        raise ValueError(f"maps: h={spec.energy} follows h={last.energy}; energies must ascend")


def _count(frame: EscapeMap, count_outside: bool) -> _Row:
    outside = frame.fate == Fate.OUTSIDE
    if count_outside and outside.any():
        fate = np.where(outside, frame.outside, frame.fate)
        frame = replace(frame, fate=fate, escape_time=np.where(outside, 0.0, frame.escape_time))
    return _Row(frame.spec, replace(compute_statistics(frame), escape_times=np.empty(0)), frame.worst_energy_error)


def _tabulate(rows: Sequence[_Row], most_crossings: int | None) -> xr.Dataset:
    # Slow to import, and seldom used.
    import xarray as xr

    spec, statistics = rows[0].spec, [row.statistics for row in rows]
    starts, escaped, direct, failed, decided = (
        np.array([getattr(counts, name) for counts in statistics], np.int64)
        for name in ("starts", "escaped", "direct", "failed", "decided")
    )
    escapes = _pad([counts.crossing_counts for counts in statistics], most_crossings)
    remaining = decided[:, None] - np.cumsum(escapes, axis=1) + escapes
    labels = [outcome.label for outcome in spec.outcomes]
    codes = (int(Fate.BOUNDED), *range(1, len(labels) + 1))
    by_fate = np.array([[counts.bounded, *counts.channel_counts] for counts in statistics], np.int64)
    columns = {
        "starts": starts, "escaped": escaped, "direct": direct, "failed": failed,
        "escaped_share": _ratio(escaped, starts), "direct_share": _ratio(direct, starts),
        "share": _ratio(by_fate, starts[:, None]),
        "crossing_count": escapes, "crossing_share": _ratio(escapes, starts[:, None]),
        "remaining": remaining, "escape_probability": _ratio(escapes, remaining),
        "mean_escape_time": np.array([counts.mean_escape_time for counts in statistics]),
        "median_escape_time": np.array([counts.median_escape_time for counts in statistics]),
        "worst_energy_error": np.array([row.worst_energy_error for row in rows]),
        "window": np.array([[getattr(row.spec.find_window(), edge) for edge in _WINDOW] for row in rows]),
    }  # fmt: skip
    coordinates = {
        "h": ("h", np.array([row.spec.energy for row in rows], float), {"long_name": "energy h", "units": "1"}),
        "n": ("n", np.arange(escapes.shape[1]), {"long_name": "upward crossings of y = 0", "units": "1"}),
        "fate": (
            "fate",
            np.array(codes, np.int8),
            {"long_name": "exit channel (k >= 1) or bounded (0)", **describe_codes(Fate, labels)},
        ),
        "edge": ("edge", list(_WINDOW)),
    }
    return xr.Dataset({name: _VARIABLES[name].with_values(values) for name, values in columns.items()}, coordinates)


def _pad(counts: Sequence[np.ndarray], most_crossings: int | None) -> np.ndarray:
    """(h, n) int64: rows of any length, padded with 0 or cut off."""
    longest = max(1, *(row.size for row in counts))
    width = longest if most_crossings is None else most_crossings + 1
    table = np.zeros((len(counts), width), np.int64)
    for index, row in enumerate(counts):
        table[index, : row.size] = row[:width]
    return table


def _ratio(part: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """part / whole; NaN where whole is 0."""
    result: np.ndarray = np.divide(part, whole, out=np.full(part.shape, np.nan), where=whole > 0)
    return result


@dataclass(frozen=True)
class _Variable:
    """Metadata of a variable: dimensions, description and its symbol in the paper."""

    dims: tuple[str, ...]
    long_name: str
    source: str = ""

    def with_values(self, values: np.ndarray) -> tuple[tuple[str, ...], np.ndarray, dict[str, str]]:
        """The variable as xarray accepts it."""
        source = {"references": f"Zotos (2014), section 5, {self.source}"} if self.source else {}
        return self.dims, values, {"long_name": self.long_name, "units": "1", **source}


_VARIABLES = {
    "starts": _Variable(("h",), "N0, starts", "N_0"),
    "escaped": _Variable(("h",), "Ne, starts that escape", "N_e"),
    "direct": _Variable(("h",), "Nde, starts that escape without an upward crossing of y = 0", "N_de"),
    "failed": _Variable(("h",), "starts whose integration failed"),
    "escaped_share": _Variable(("h",), "Ne/N0, share that escapes", "N_e/N_0(h)"),
    "direct_share": _Variable(("h",), "Nde/N0, share that escapes directly", "N_de/N_0(h)"),
    "share": _Variable(("h", "fate"), "share of N0 that is bounded or escapes through each channel", "percentages against h"),
    "crossing_count": _Variable(("h", "n"), "dN_n, starts that escape after exactly n crossings", "dN_n"),
    "crossing_share": _Variable(("h", "n"), "dN_n/N0, share that escapes after exactly n crossings", "dN_n/N_0"),
    "remaining": _Variable(("h", "n"), "N_n, starts that have not escaped before the n-th crossing", "N_n"),
    "escape_probability": _Variable(("h", "n"), "p_n, probability of escape after n crossings", "p_n = dN_n/N_n"),
    "mean_escape_time": _Variable(("h",), "mean escape time"),
    "median_escape_time": _Variable(("h",), "median escape time"),
    "worst_energy_error": _Variable(("h",), "largest relative energy error of any orbit"),
    "window": _Variable(("h", "edge"), "window of the starts"),
}


def _provenance(spec: MapSpec, count_outside: bool) -> dict[str, Any]:
    """Provenance without energy and window, which differ between the maps."""
    common: dict[str, Any] = {name: value for name, value in spec.provenance().items() if name not in ("energy", "window")}
    return {**common, "count_outside": int(count_outside)}
