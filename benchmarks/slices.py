"""Time per start of maps on other slices beside (x, px), with kernels and exits known. Run: uv run python -m benchmarks.slices"""

from __future__ import annotations

import statistics
import time

from engine import CASES, Coordinate, Direction, MapSpec, ParameterAxis, Plane, Slice, System, compute_map

ENERGY, SIDE, T_MAX, REPEATS = 0.2, 224, 1e3, 5
C = Coordinate
SLICES = {
    "(x, px)": Plane.X_PX,
    "(x, y)": Plane.X_Y,
    "(y, py)": Plane.Y_PY,
    "(x, h)": Plane.X_H,
    "(x, θ)": Slice(C.X, C.THETA),
    "(x, y), tangential": Plane.TANGENTIAL,
    "oblique": Slice(Direction("u", x=1.0, y=0.3), C.PX),
    "(x, ε), ε from 1 to 2": Slice(C.X, ParameterAxis("epsilon", 1.0, 2.0, System("I"))),
}


def microseconds_per_start(plane: Slice) -> float:
    """Median wall time of a map per start inside, after one map that finds exits and windows."""
    energy = ENERGY if plane.energy_axis is None else (ENERGY, 0.5)
    spec = MapSpec(CASES["I"], plane, energy, (SIDE, SIDE), t_max=T_MAX)
    starts = int(compute_map(spec).interior.sum())
    times = []
    for _ in range(REPEATS):
        begun = time.perf_counter()
        compute_map(spec)
        times.append(time.perf_counter() - begun)
    return 1e6 * statistics.median(times) / starts


def main() -> None:
    """Print a table."""
    found = {name: microseconds_per_start(plane) for name, plane in SLICES.items()}
    print(f"case I, {SIDE} × {SIDE} starts, t = {T_MAX:g}\n\n| slice | µs per start inside | beside (x, px) |\n|---|---|---|")
    for name, microseconds in found.items():
        print(f"| {name} | {microseconds:.2f} | {microseconds / found['(x, px)']:.2f} |")


if __name__ == "__main__":
    main()
