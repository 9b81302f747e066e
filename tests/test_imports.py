"""Importing a module imports no large libraries and reads no settings. Each test imports in a child process."""

from __future__ import annotations

import os
import runpy
import sys
from pathlib import Path

from tests.forked import Finished, run

ROOT = Path(__file__).parents[1]


def list_imported(*names: str) -> None:
    sys.stdout.write(" ".join(name for name in names if name in sys.modules))


SLOW = (
    *("scipy.linalg", "scipy.special", "scipy.optimize", "scipy.integrate", "scipy.ndimage", "shapely", "contourpy"),
    *("pandas", "xarray", "zarr", "matplotlib", "bokeh", "holoviews", "panel"),
)
"""Libraries that are imported at their first use only."""


def import_engine() -> None:
    import engine  # noqa: F401

    list_imported("numpy", "numba", *SLOW)


def show_all_helps() -> None:
    import contextlib
    import io

    from cli.main import COMMANDS, main

    for name in COMMANDS:
        with contextlib.redirect_stdout(io.StringIO()) as shown:
            assert main([name, "--help"]) == 0
        assert "Usage" in shown.getvalue()
    list_imported("typer", "engine", "numba", *SLOW)


def review_a_potential() -> None:
    import contextlib
    import io

    from cli.main import main

    with contextlib.redirect_stdout(io.StringIO()):
        assert main(["potential", "HH"]) == 0
    list_imported("engine", "numba", *SLOW)


def list_lyapunov_orbits() -> None:
    import contextlib
    import io

    from cli.main import main

    with contextlib.redirect_stdout(io.StringIO()):
        assert main(["lyapunov", "I", "--energy", "0.19"]) == 0
    # Numba imports numba.np.linalg when it compiles.
    list_imported("typer", *SLOW, "numba.np.linalg")


def import_figures() -> None:
    import reproduction.figures.all_figures  # noqa: F401

    list_imported("panel", "tornado", "bokeh.server", "matplotlib.pyplot", "matplotlib.figure")


def import_page() -> None:
    os.environ["ESCAPE_EXPLORER_THREADS"] = "0"
    import app.app_hooks
    import app.session.page  # noqa: F401
    from app.runtime import process_state

    list_imported("app.session.explorer", "matplotlib.figure")
    assert process_state._current_state is None


def serve_with_an_invalid_setting() -> None:
    os.environ["ESCAPE_EXPLORER_THREADS"] = "0"
    os.chdir(ROOT)
    sys.argv = ["panel", "serve", "app", "--port", "0"]
    runpy.run_module("panel", run_name="__main__")


def test_engine_imports_no_large_library_but_numpy(tmp_path: Path) -> None:
    assert run(tmp_path, import_engine) == Finished(0, "numpy", "")


def test_help_of_all_commands_imports_no_large_library(tmp_path: Path) -> None:
    assert run(tmp_path, show_all_helps) == Finished(0, "typer engine", "")


def test_potential_command_imports_no_compiler(tmp_path: Path) -> None:
    assert run(tmp_path, review_a_potential) == Finished(0, "engine", "")


def test_lyapunov_command_loads_neither_scipy_nor_a_compiler_nor_a_plotting_library(tmp_path: Path) -> None:
    # The first call fills the caches on disk.
    run(tmp_path, list_lyapunov_orbits)
    assert run(tmp_path, list_lyapunov_orbits) == Finished(0, "typer", "")


def test_figures_import_no_server_and_no_pyplot(tmp_path: Path) -> None:
    assert run(tmp_path, import_figures) == Finished(0, "matplotlib.figure", "")


def test_page_imports_no_matplotlib_before_a_download_and_does_not_read_the_environment_before_the_server_starts(
    tmp_path: Path,
) -> None:
    assert run(tmp_path, import_page) == Finished(0, "app.session.explorer", "")


def test_invalid_setting_ends_the_server_with_one_sentence(tmp_path: Path) -> None:
    ended = run(tmp_path, serve_with_an_invalid_setting)
    assert ended.code == 2
    assert ended.err.splitlines()[-1] == "ESCAPE_EXPLORER_THREADS='0': must be a whole number from 1 to 1024"
