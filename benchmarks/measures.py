"""Print the tables of the documents on measures of basins and escapes, for maps of (x, px).

Run: uv run python -m benchmarks.measures
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache

from engine import (
    CASES,
    EscapeMap,
    MapSpec,
    Plane,
    compute_basin_entropy,
    compute_map,
    compute_statistics,
    compute_uncertainty_exponent,
    compute_wada_test,
    fit_decay_laws,
)
from engine.measures.basins.starts import exit_labels

SIDE = 224
SIDES = (SIDE, 2 * SIDE, 4 * SIDE)
# Case and energy.
System = tuple[str, float]

ENTROPIES: tuple[System, ...] = (("I", 0.2), ("II", 0.2), ("III", 0.45))
# System whose basin entropy is also computed on finer grids.
FINER: System = ("II", 0.25)
# Systems, and whether bounded orbits count as a basin.
WADA: tuple[tuple[System, bool], ...] = ((("II", 0.2), False), (FINER, False), (("III", 0.45), False), (("III", 0.45), True))
EXPONENTS: tuple[System, ...] = (
    ("I", 0.15), ("I", 0.3), ("II", 0.17), ("II", 0.2), ("II", 0.25), ("II", 0.3), ("III", 0.26), ("III", 0.45), ("III", 0.6),
)  # fmt: skip
LAWS: tuple[System, ...] = (("II", 0.2), ("II", 0.3), ("I", 0.15), ("I", 0.3), ("III", 0.26), ("III", 0.45), ("III", 0.6))


@cache
def map_of(system: System, side: int = SIDE, t_max: float = 1e5) -> EscapeMap:
    return compute_map(spec_of(system, side, t_max))


def spec_of(system: System, side: int = SIDE, t_max: float = 1e5) -> MapSpec:
    case, energy = system
    return MapSpec(CASES[case], Plane.X_PX, energy, (side, side), t_max=t_max)


def title(system: System) -> str:
    return "{}, h = {}".format(*system)


def entropy_row(system: System) -> list[str]:
    whole = map_of(system)
    counted, escaping = compute_basin_entropy(whole), compute_basin_entropy(*exit_labels(whole.fate, bounded=False))
    values = (counted.s_b, counted.s_b_error), (counted.s_bb, counted.s_bb_error), (escaping.s_bb, escaping.s_bb_error)
    return [title(system), *(f"{value:.3f}±{error:.3f}" for value, error in values)]


def wada_row(system: System, bounded: bool) -> list[str]:
    tests = [compute_wada_test(*exit_labels(map_of(system, side).fate, bounded=bounded)) for side in SIDES]
    cells = (f"{test.radius:g} ({test.radius_99:g})" for test in tests)
    return [title(system) + (", bounded as a basin" if bounded else ""), *cells]


def exponent_row(system: System, t_max: float = 1e5) -> list[str]:
    found = compute_uncertainty_exponent(replace(spec_of(system), t_max=t_max), rng=0)
    return [title(system), f"{t_max:g}", f"{found.exponent:.3f}", f"{found.low:.3f} to {found.high:.3f}"]


def law_row(system: System, t_max: float = 1e4) -> list[str]:
    laws = fit_decay_laws(compute_statistics(map_of(system, t_max=t_max)), t_max)
    return [title(system), f"{t_max:g}", laws.describe()]


def write_table(heads: Iterable[str], rows: Iterable[list[str]]) -> None:
    heads = list(heads)
    print(f"\n| {' | '.join(heads)} |\n|{'---|' * len(heads)}")
    for row in rows:
        print(f"| {' | '.join(row)} |", flush=True)


def main() -> None:
    print(f"(x, px), {SIDE} × {SIDE}, t_max = 10⁵ unless given")
    write_table(("basin entropy", "S_b", "S_bb", "S_bb without bounded"), map(entropy_row, ENTROPIES))
    finer: Callable[[int], str] = lambda side: f"{compute_basin_entropy(map_of(FINER, side)).s_b:.3f}"  # noqa: E731
    write_table(("S_b at pixels per side", *map(str, SIDES)), [[title(FINER), *map(finer, SIDES)]])
    write_table(("Wada radius (99 %) at pixels per side", *map(str, SIDES)), (wada_row(*one) for one in WADA))
    exponents = [(system, 1e5) for system in EXPONENTS] + [(EXPONENTS[0], 1e3)]
    write_table(("uncertainty exponent", "t_max", "α", "95 % interval"), (exponent_row(*one) for one in exponents))
    laws = [(system, 1e4) for system in LAWS] + [(("I", 0.15), 1e5)]
    write_table(("decay law", "t_max", "verdict"), (law_row(*one) for one in laws))


if __name__ == "__main__":
    main()
