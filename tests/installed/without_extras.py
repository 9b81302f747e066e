"""Check that the library without extras computes and draws, and names the extra of what is missing."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from escape_explorer.plots.browser.compiled_files import KERNELS, has_compiled

import escape_explorer
from escape_explorer import CASES, MapSpec, Plane, SweepSpec, compute_map, compute_sweep, integrate_orbit, open_result

PROGRAM = str(Path(sys.executable).with_name("escape-explorer"))


def check_refusal(call: Callable[[], Any], package: str, extra: str) -> None:
    """Check that a call names the package and the extra that it needs."""
    found = "no error"
    try:
        call()
    except ModuleNotFoundError as error:
        found = str(error)
    assert found == f"{package} is not installed: pip install 'escape-explorer[{extra}]'", found


def run_program(*arguments: str) -> str:
    """Return what a command writes to its error stream."""
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True).stderr


def main() -> None:
    """Compute, draw and ask for what is missing."""
    escapes = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.45, (40, 40), t_max=100.0))
    escapes.plot()
    escapes.save("map.nc")
    assert open_result("map.nc").spec == escapes.spec
    integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.6), 100.0).plot()
    long_orbit = integrate_orbit(CASES["I"], (0.1, 0.0, 0.0, 0.3), 2e4)
    long_orbit.plot(show="sali")
    check_refusal(long_orbit.plot, "datashader", "page")
    run_program("map", "III", "--energy", "0.45", "--resolution", "40", "--t-max", "100", "--output", "both")
    assert Path("both.png").stat().st_size > 1000
    assert (open_result("both.nc").fate == escapes.fate).all()
    Path("netcdf4.nc").write_bytes(b"\x89HDF\r\n")
    check_refusal(escapes.to_holoviews, "holoviews", "page")
    check_refusal(lambda: escape_explorer.Explorer, "panel", "page")
    check_refusal(lambda: open_result("netcdf4.nc"), "h5netcdf", "files")
    check_refusal(
        lambda: compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, (0.3,), (9, 9), t_max=10.0), "sweep.zarr"), "zarr", "files"
    )
    assert "pip install 'escape-explorer[page]'" in run_program("serve")
    # The files compiled in advance are those of the installed sources.
    assert has_compiled(KERNELS)


if __name__ == "__main__":
    main()
