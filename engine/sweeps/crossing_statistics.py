"""Who leaves after how many crossings of y = 0, against energy: the statistics of Zotos (2014), section 5, in one table."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import CancelledError, Executor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from engine.dynamics.fates import Fate
from engine.dynamics.planes import Plane, Window
from engine.maps.compute import compute_map
from engine.maps.result import EscapeMap, describe_codes
from engine.maps.spec import MapSpec
from engine.potentials.potential import Potential
from engine.statistics.escape_statistics import EscapeStatistics, compute_statistics
from engine.sweeps.energy_curves import EnergyCurvesSpec

_WINDOW = tuple(Window.__dataclass_fields__)


def compute_crossing_statistics(
    potential: Potential,
    plane: Plane,
    energies: Sequence[float],
    resolution: tuple[int, int] = (225, 225),
    t_max: float = 1e5,
    *,
    window: Window | None = None,
    count_outside: bool = False,
    most_crossings: int | None = None,
    on_progress: Callable[[float], None] | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Compute a map at each energy and count what leaves, and after how many crossings.

    One map is held at a time.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        (x, y) or (x, px). The paper's statistics are on (x, px), where all starts lie on y = 0.
    energies
        h, finite, dimensionless, 1 to 1000 of them; sorted and made unique.
    resolution
        (columns, rows) of each map.
    t_max
        How long orbits are followed, 0 < t_max ≤ 1e8.
    window
        One for all energies; None for the whole interior of each.
    count_outside, most_crossings
        As of `tabulate_crossing_statistics`.
    on_progress
        Called in this thread with the share of the work that is done, 0 to 1.
    cancel
        When set, the work stops within about 0.1 s.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.

    Returns
    -------
    As of `tabulate_crossing_statistics`.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When a parameter is out of its range, or no exit is defined at one of the energies.
    """
    sweep = EnergyCurvesSpec(potential, plane, tuple(energies), resolution, t_max, exponent=False)
    specs = [replace(sweep.point(h).map_spec, window=window) if window else sweep.point(h).map_spec for h in sweep.energies]
    _check_most_crossings(most_crossings)
    maps = _compute_maps(specs, on_progress, cancel, executor)
    return tabulate_crossing_statistics(maps, count_outside=count_outside, most_crossings=most_crossings)


def tabulate_crossing_statistics(
    maps: Iterable[EscapeMap], *, count_outside: bool = False, most_crossings: int | None = None
) -> xr.Dataset:
    """Count what leaves in maps of rising energy, and after how many upward crossings of y = 0.

    N0 are the starts, Ne those that escape, Nde those that do so directly, without a crossing, dN_n those that escape after
    exactly n crossings, N_n those not yet escaped before the n-th, and p_n = dN_n / N_n (Zotos 2014, section 5, after
    Contopoulos, Harsoula & Lukes-Gerakopoulos 2012). The start itself is no crossing, and only crossings before the exit count.

    Parameters
    ----------
    maps
        Complete, on (x, y) or (x, px), alike in all but energy and window, energies rising; taken one by one.
    count_outside
        Whether starts outside belong to N0, as orbits that escape at t = 0 through the channel they lie in, without a crossing.
        The percentages of the paper are of this kind. They depend on the windows; the interior alone does not.
    most_crossings
        The table ends at this n, 0 or more, though some leave later; None for as many as there are, often thousands.

    Returns
    -------
    A dataset, dimensionless throughout, against `h` (m,), `n` (0, 1, …) and `fate` (bounded, then channels 1, 2, …):

    - `starts`, `escaped`, `direct`, `failed` (h): N0, Ne, Nde and those no step could be found for, int64.
    - `escaped_share`, `direct_share` (h): Ne/N0, Nde/N0; NaN where there are no starts.
    - `share` (h, fate): of N0; the sum is 1 when none failed.
    - `crossing_count`, `crossing_share` (h, n): dN_n and dN_n/N0; 0 where nothing leaves.
    - `remaining` (h, n): N_n, failed ones left out, so that it ends at the number of bounded ones.
    - `escape_probability` (h, n): p_n; NaN where nobody remains, 0 where all that remain are bounded.
    - `mean_escape_time`, `median_escape_time` (h): of those that leave, NaN when none does.
    - `worst_energy_error` (h), and `window` (h, edge).

    Attributes tell what made the maps.

    Raises
    ------
    ValueError
        When there are no maps, one is not complete, is on (x, h) or unlike the first, energies do not rise, or
        `most_crossings` is negative.
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
    """What is counted in one map."""

    spec: MapSpec
    statistics: EscapeStatistics
    worst_energy_error: float


def _compute_maps(
    specs: Sequence[MapSpec],
    on_progress: Callable[[float], None] | None,
    cancel: threading.Event | None,
    executor: Executor | None,
) -> Iterator[EscapeMap]:
    for place, spec in enumerate(specs):

        def report(frame: EscapeMap, done: int = place) -> None:
            if on_progress is not None:
                on_progress((done + frame.progress) / len(specs))

        result = compute_map(spec, report if on_progress is not None else None, cancel, executor)
        if not result.complete:
            raise CancelledError
        yield result


def _check_most_crossings(most_crossings: int | None) -> None:
    if most_crossings is not None and most_crossings < 0:
        raise ValueError(f"most_crossings={most_crossings}: must be 0 or more, or None")


def _check_next(frame: EscapeMap, last: MapSpec | None) -> None:
    spec = frame.spec
    if isinstance(spec.energy, tuple):
        raise ValueError(f"maps: one is on {spec.plane.value}; each must have one energy")
    if not frame.complete:
        raise ValueError(f"maps: that at h={spec.energy} is not complete, {frame.undecided:.2%} of its starts are undecided")
    if last is None:
        return
    assert not isinstance(last.energy, tuple)
    if replace(spec, energy=last.energy, window=last.window) != last:
        raise ValueError(f"maps: {spec} is unlike {last}; all but energy and window must be equal")
    if spec.energy <= last.energy:
        raise ValueError(f"maps: h={spec.energy} follows h={last.energy}; energies must rise")


def _count(frame: EscapeMap, count_outside: bool) -> _Row:
    outside = frame.fate == Fate.OUTSIDE
    if count_outside and outside.any():
        fate = np.where(outside, frame.outside, frame.fate)
        frame = replace(frame, fate=fate, escape_time=np.where(outside, 0.0, frame.escape_time))
    return _Row(frame.spec, replace(compute_statistics(frame), escape_times=np.empty(0)), frame.worst_energy_error)


def _tabulate(rows: Sequence[_Row], most_crossings: int | None) -> xr.Dataset:
    spec, statistics = rows[0].spec, [row.statistics for row in rows]
    starts, escaped, direct, failed, decided = (
        np.array([getattr(counts, name) for counts in statistics], np.int64)
        for name in ("starts", "escaped", "direct", "failed", "decided")
    )
    leaving = _pad([counts.crossing_counts for counts in statistics], most_crossings)
    remaining = decided[:, None] - np.cumsum(leaving, axis=1) + leaving
    codes = (int(Fate.BOUNDED), *range(1, spec.potential.channels + 1))
    by_fate = np.array([[counts.bounded, *counts.channel_counts] for counts in statistics], np.int64)
    columns = {
        "starts": starts, "escaped": escaped, "direct": direct, "failed": failed,
        "escaped_share": _ratio(escaped, starts), "direct_share": _ratio(direct, starts),
        "share": _ratio(by_fate, starts[:, None]),
        "crossing_count": leaving, "crossing_share": _ratio(leaving, starts[:, None]),
        "remaining": remaining, "escape_probability": _ratio(leaving, remaining),
        "mean_escape_time": np.array([counts.mean_escape_time for counts in statistics]),
        "median_escape_time": np.array([counts.median_escape_time for counts in statistics]),
        "worst_energy_error": np.array([row.worst_energy_error for row in rows]),
        "window": np.array([[getattr(row.spec.window, edge) for edge in _WINDOW] for row in rows]),
    }  # fmt: skip
    coordinates = {
        "h": ("h", np.array([row.spec.energy for row in rows], float), {"long_name": "energy h", "units": "1"}),
        "n": ("n", np.arange(leaving.shape[1]), {"long_name": "upward crossings of y = 0", "units": "1"}),
        "fate": ("fate", np.array(codes, np.int8), {"long_name": "exit channel (k >= 1) or bounded (0)", **describe_codes(Fate)}),
        "edge": ("edge", list(_WINDOW)),
    }
    return xr.Dataset({name: _VARIABLES[name].with_values(values) for name, values in columns.items()}, coordinates)


def _pad(counts: Sequence[np.ndarray], most_crossings: int | None) -> np.ndarray:
    """(h, n) int64: rows of any length, filled up with 0 or cut off."""
    longest = max(1, *(row.size for row in counts))
    width = longest if most_crossings is None else most_crossings + 1
    table = np.zeros((len(counts), width), np.int64)
    for place, row in enumerate(counts):
        table[place, : row.size] = row[:width]
    return table


def _ratio(part: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """part / whole; NaN where the whole is 0."""
    result: np.ndarray = np.divide(part, whole, out=np.full(part.shape, np.nan), where=whole > 0)
    return result


@dataclass(frozen=True)
class _Variable:
    """A column of the table: what it is against, what it is, and where it is defined."""

    dims: tuple[str, ...]
    long_name: str
    source: str = ""

    def with_values(self, values: np.ndarray) -> tuple[tuple[str, ...], np.ndarray, dict[str, str]]:
        """The form in which xarray takes it."""
        source = {"references": f"Zotos (2014), section 5, {self.source}"} if self.source else {}
        return self.dims, values, {"long_name": self.long_name, "units": "1", **source}


_VARIABLES = {
    "starts": _Variable(("h",), "N0, starts", "N_0"),
    "escaped": _Variable(("h",), "Ne, starts that escape", "N_e"),
    "direct": _Variable(("h",), "Nde, starts that escape without an upward crossing of y = 0", "N_de"),
    "failed": _Variable(("h",), "starts whose orbit could not be followed"),
    "escaped_share": _Variable(("h",), "Ne/N0, share that escapes", "N_e/N_0(h)"),
    "direct_share": _Variable(("h",), "Nde/N0, share that escapes directly", "N_de/N_0(h)"),
    "share": _Variable(("h", "fate"), "share of N0 that is bounded or leaves by each channel", "percentages against h"),
    "crossing_count": _Variable(("h", "n"), "dN_n, starts that escape after exactly n crossings", "dN_n"),
    "crossing_share": _Variable(("h", "n"), "dN_n/N0, share that escapes after exactly n crossings", "dN_n/N_0"),
    "remaining": _Variable(("h", "n"), "N_n, starts that have not escaped before the n-th crossing", "N_n"),
    "escape_probability": _Variable(("h", "n"), "p_n, probability of escape after n crossings", "p_n = dN_n/N_n"),
    "mean_escape_time": _Variable(("h",), "mean escape time of those that escape"),
    "median_escape_time": _Variable(("h",), "median escape time of those that escape"),
    "worst_energy_error": _Variable(("h",), "largest relative energy error of any orbit"),
    "window": _Variable(("h", "edge"), "window of the starts"),
}


def _provenance(spec: MapSpec, count_outside: bool) -> dict[str, Any]:
    """What is the same at all energies."""
    made_by: dict[str, Any] = {name: value for name, value in spec.provenance().items() if name not in ("energy", "window")}
    return {**made_by, "count_outside": int(count_outside)}
