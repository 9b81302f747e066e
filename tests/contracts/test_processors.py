"""Maps are equal to the bit with and without AVX-512. If NumPy and OpenBLAS also do without, escape times differ slightly."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from collections.abc import Callable, Mapping

import numpy as np
import pytest

from engine import POTENTIALS, MapSpec, Plane, compute_map, parse_formula
from tests.processors import X86_64_V3

SPECS = [
    MapSpec(POTENTIALS["I"], Plane.X_PX, 0.19, (40, 40), t_max=2e3),
    MapSpec(POTENTIALS["II"], Plane.X_Y, 0.18, (40, 40), t_max=2e3),
    MapSpec(POTENTIALS["III"], Plane.X_PX, 0.35, (40, 40), t_max=2e3),
    MapSpec(POTENTIALS["Logarithmic bar"], Plane.X_PX, POTENTIALS["Logarithmic bar"].well.energy_at(1.1), (24, 24), t_max=200.0),
    MapSpec(parse_formula("½r² − 2x²y exp(−y²)"), Plane.X_PX, 0.05, (24, 24), t_max=200.0),
]


def compute_maps(path: str) -> None:
    """Write the arrays of all maps to a file."""
    maps = [compute_map(spec) for spec in SPECS]
    names = ("fate", "escape_time", "crossings", "evidence")
    np.savez(path, **{f"{k} {name}": getattr(found, name) for k, found in enumerate(maps) for name in names})


@pytest.fixture(scope="module")
def compute(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Mapping[str, str]], dict[str, np.ndarray]]:
    """Return a function that computes the maps in a process with some environment variables."""
    folder = tmp_path_factory.mktemp("processors")

    def compute(variables: Mapping[str, str]) -> dict[str, np.ndarray]:
        code = f"from tests.contracts.test_processors import compute_maps; compute_maps({str(folder / 'maps.npz')!r})"
        subprocess.run([sys.executable, "-c", code], check=True, env=os.environ | variables)
        with np.load(folder / "maps.npz") as found:
            return dict(found)

    return compute


@pytest.mark.slow
@pytest.mark.skipif(platform.machine() != "x86_64", reason="compares two kinds of x86-64")
def test_maps_do_not_depend_on_the_processor(compute: Callable[[Mapping[str, str]], dict[str, np.ndarray]]) -> None:
    own = compute({})
    kernels = compute({name: value for name, value in X86_64_V3.items() if name.startswith("NUMBA")})
    libraries = compute(X86_64_V3)
    for name, expected in own.items():
        np.testing.assert_array_equal(kernels[name], expected, err_msg=name)
        if name.endswith("escape_time"):
            # The curves of the exits are fitted by NumPy and OpenBLAS, whose last bits depend on the processor.
            np.testing.assert_allclose(libraries[name], expected, rtol=1e-9, err_msg=name)
        else:
            np.testing.assert_array_equal(libraries[name], expected, err_msg=name)
