"""The program ``escape-explorer`` has the right help, version, exit codes and error messages."""

from __future__ import annotations

import signal
import subprocess
import sys
from functools import partial
from importlib import metadata
from pathlib import Path

import pytest
from typer import Context
from typer.main import get_command

from cli.main import FAILED, INTERRUPTED, INVALID_REQUEST, program
from engine import CASES
from engine.maps.spec import DEFAULT_RESOLUTION
from plots.printed.figure_style import FigureStyle
from tests.cli.conftest import Run

COMMANDS = (
    "map",
    "orbit",
    "ensemble",
    "lyapunov",
    "measures",
    "curves",
    "where",
    "study",
    "sweep",
    "potential",
    "versions",
    "reproduce",
    "serve",
)
MAP = ("map", "I", "--energy", 0.19, "--resolution", 9, "--t-max", 100)
INVALID = {
    "missing command": (),
    "unknown command": ("paint",),
    "missing case": ("map", "--energy", 0.2),
    "unknown case": ("map", "V", "--energy", 0.2),
    "missing energy": ("map", "I"),
    "single energy on (x, h)": ("map", "I", "--plane", "x_h", "--energy", 0.2),
    "energy range on (x, px)": ("map", "I", "--energies", 0.2, 0.3),
    "energy not a number": ("map", "I", "--energy", "high"),
    "energy not finite": ("map", "I", "--energy", "nan"),
    "resolution not a number": ("map", "I", "--energy", 0.2, "--resolution", "fine"),
    "zero resolution": ("map", "I", "--energy", 0.2, "--resolution", 0),
    "empty window": ("map", "I", "--energy", 0.2, "--window", 0, 0, 0, 1),
    "zero t_max": ("map", "I", "--energy", 0.2, "--t-max", 0),
    "zero threads": ("map", "I", "--energy", 0.2, "--threads", 0),
    "unknown picture": ("map", "I", "--energy", 0.2, "--picture", "sunset"),
    "unknown palette": ("map", "I", "--energy", 0.2, "--palette", "loud"),
    "figure too narrow": ("map", "I", "--energy", 0.2, "--width", 1),
    "letters too large": ("orbit", "I", "--state", 0, 0, 0, 0.1, "--font-size", 99),
    "manifolds on (x, y)": ("map", "I", "--energy", 0.2, "--plane", "x_y", "--manifolds", 1),
    "too many manifold images": ("map", "I", "--energy", 0.2, "--manifolds", 7),
    "unknown option with one minus": ("lyapunov", "-e", "I", "--energy", 0.2),
    "origins of a backward map": ("map", "I", "--energy", 0.2, "--backward", "--origins"),
    "missing output folder": ("map", "I", "--energy", 0.2, "--output", "/no/such/folder/name"),
    "output is a folder": ("lyapunov", "I", "--energy", 0.2, "--output", "/"),
    "missing start": ("orbit", "I", "--energy", 0.2),
    "start without energy": ("orbit", "I", "--start", 0, 0),
    "forbidden start": ("orbit", "I", "--energy", 0.2, "--start", 0, 2),
    "start and state": ("orbit", "I", "--energy", 0.2, "--start", 0, 0, "--state", 0, 0, 0, 0.1),
    "state and energy": ("orbit", "I", "--energy", 0.2, "--state", 0, 0, 0, 0.1),
    "energy and start on (x, h)": ("orbit", "I", "--plane", "x_h", "--energy", 0.2, "--start", 0, 0.2),
    "energy without Lyapunov orbits": ("lyapunov", "III", "--energy", 100),
    "low above high": ("curves", "I", "--low", 0.3, "--high", 0.2, "--count", 3),
    "curves on (x, h)": ("curves", "I", "--plane", "x_h", "--low", 0.1, "--high", 0.2, "--count", 3),
    "unknown study": ("study", "fractals", "I"),
    "study against an unknown parameter": ("study", "energies", "I", "--against", "mass"),
    "entering through the exits on a plane": ("ensemble", "I", "--energy", 0.2, "--entering", "--plane", "x_px"),
    "entering through closed exits": ("ensemble", "I", "--energy", 0.1, "--entering"),
    "too many orbits of a movie": ("ensemble", "I", "--energy", 0.2, "--count", 30_000, "--output", "film.webp"),
    "sweep without a count": ("sweep", "I", "--low", 0.13, "--high", 0.2, "--store", "store.zarr"),
    "sweep of an energy and of a range": ("sweep", "I", "--energy", 0.2, "--low", 0.13, "--store", "store.zarr"),
    "sweep on (x, h)": ("sweep", "I", "--energy", 0.2, "--plane", "x_h", "--store", "store.zarr"),
    "sweep without energies": ("sweep", "I", "--store", "store.zarr"),
    "sweep up to infinity": ("sweep", "I", "--low", 0.13, "--high", "inf", "--count", 3, "--store", "store.zarr"),
    "sweep along one axis twice": ("sweep", "I", "--axis", "h=0.1:0.2:3", "--axis", "h=0.1:0.2:3", "--store", "store.zarr"),
    "store of a map in a missing folder": ("map", "I", "--energy", 0.2, "--store", "no/map.nc"),
    "fixed value of a named plane": ("map", "I", "--energy", 0.2, "--fix", "y=0.1"),
    "start not finite": ("orbit", "I", "--energy", 0.2, "--start", 0.1, "nan"),
    "start of a live figure not finite": ("live", "I", "--energy", 0.2, "--start", "0.1,nan"),
    "energy of a study not finite": ("study", "plate", "I", "--energy", "nan"),
    "study of a family at rest": ("study", "family", "III", "--state", 0, 0, 0, 0, "--t-max", 10),
    "search among more values than maps": (
        "where", "I", "--quantity", "s_b", "--value", 0.5, "--low", 0.15, "--high", 0.2, "--count", 9, "--most-maps", 5,
    ),
    "threads and a cluster": ("map", "I", "--energy", 0.2, "--threads", 2, "--local-cluster", 2),
    "unknown figure": ("reproduce", "I-xh", "IV-xh", "--output", "new"),
    "figures in a missing folder": ("reproduce", "I-xh", "--output", "no/such"),
    "port below 1": ("serve", "--port", 0),
    "port above 65535": ("serve", "--port", 70000),
    "map too small to measure": ("measures", "I", "--energy", 0.2, "--resolution", 3, "--t-max", 10),
}  # fmt: skip


@pytest.mark.parametrize("name", INVALID)
def test_invalid_request_prints_one_line_and_writes_nothing(
    name: str, run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*INVALID[name])
    assert (code, out, list(tmp_path.iterdir())) == (INVALID_REQUEST, "", [])
    assert err.startswith("escape-explorer: ")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (("curves", "I", "--energies", 0.3, 0.5), ("--energies: curves has no such option", "--low, --high, --count")),
        (("orbit", "I", "--x=0.1"), ("--x: orbit has no such option", "--start, --state")),
        (("map", "I", "--no-evidences"), ("--no-evidences: map has no such option", "--no-evidence,", "--help")),
    ],
)
def test_an_unknown_option_is_answered_by_all_options(words: tuple[object, ...], wanted: tuple[str, ...], run: Run) -> None:
    code, _, err = run(*words)
    assert code == INVALID_REQUEST
    assert [part for part in wanted if part not in err] == []


def test_control_characters_in_a_message_are_escaped(run: Run) -> None:
    _, _, err = run("reproduce", "I-xh", "--output", "no/such\x1b[2J")
    assert err.rstrip("\n").isprintable()


@pytest.mark.parametrize("command", COMMANDS)
def test_help_contains_an_example(command: str, run: Run) -> None:
    code, out, _ = run(command, "--help")
    assert code == 0
    assert f"escape-explorer {command} " in out.partition("Examples:")[2]


def test_help_lists_all_commands_and_the_version_is_that_of_the_package(run: Run) -> None:
    _, out, _ = run("--help")
    assert all(f" {command} " in out for command in COMMANDS)
    assert run("--version") == (0, f"escape-explorer {metadata.version('escape-explorer')}\n", "")


def test_unwritable_output_exits_with_failed(run: Run, tmp_path: Path) -> None:
    (tmp_path / "taken.nc").mkdir()
    code, _, err = run(*MAP, "--output", tmp_path / "taken", "--format", "nc")
    assert code == FAILED
    assert err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["taken.nc"]


def test_failed_computation_writes_nothing(run_in_terminal: Run, tmp_path: Path) -> None:
    def fail() -> None:
        raise RuntimeError("first line\nsecond line")

    code, out, line = run_in_terminal("map", fail, *MAP, "--output", tmp_path / "map")
    assert (code, out) == (FAILED, "")
    assert line.endswith("escape-explorer: RuntimeError: first line second line")
    assert not any(tmp_path.iterdir())


def test_missing_dask_is_reported_with_the_install_command(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    code, _, err = run(*MAP, "--local-cluster", 1, "--output", tmp_path / "map")
    assert code == FAILED
    assert err == "escape-explorer: distributed is not installed: pip install 'escape-explorer[cluster]'\n"
    assert not any(tmp_path.iterdir())


# A map that takes minutes, so its stage has begun and not ended when the signals come.
LONG = ("map", "III", "--energy", 0.26, "--resolution", 300, "--t-max", 1e7)


@pytest.mark.parametrize("times", [1, 2])
def test_ctrl_c_cancels_a_map_and_a_second_ctrl_c_ends_it_at_once(times: int, run_in_terminal: Run, tmp_path: Path) -> None:
    before = signal.getsignal(signal.SIGINT)

    def interrupt() -> None:
        for _ in range(times):
            signal.raise_signal(signal.SIGINT)

    code, out, line = run_in_terminal("map", interrupt, *LONG, "--trust", "--output", tmp_path / "map")
    assert (code, out) == (INTERRUPTED, "")
    assert "escape-explorer: interrupted" in line
    assert not any(tmp_path.iterdir())
    assert signal.getsignal(signal.SIGINT) is before


def test_ctrl_c_keeps_the_store_of_a_map_and_says_so(run_in_terminal: Run, tmp_path: Path) -> None:
    store = tmp_path / "kept.nc"
    interrupt = partial(signal.raise_signal, signal.SIGINT)
    code, _, line = run_in_terminal("map", interrupt, *LONG, "--output", tmp_path / "map", "--store", store)
    assert code == INTERRUPTED
    assert f"interrupted; finished blocks are kept in {store}, and the same command continues from there" in line
    assert [file.name for file in tmp_path.iterdir()] == [store.name]


@pytest.mark.parametrize(("word", "code"), [("mpa", INVALID_REQUEST), ("--help", 0), ("serve --help", 0)])
def test_wrong_word_and_help_do_not_import_the_engine(word: str, code: int) -> None:
    script = "import sys; from cli.main import main; print(main(sys.argv[1:]), 'engine' in sys.modules, 'numba' in sys.modules)"
    command = [sys.executable, "-c", script, *word.split()]
    process = subprocess.run(command, cwd=Path(__file__).parents[2], capture_output=True, text=True, check=True)
    assert process.stdout.endswith(f"{code} False False\n")


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_has_a_help_text(name: str) -> None:
    program_with_all = get_command(program)
    _, command, _ = program_with_all.resolve_command(Context(program_with_all), [name])
    assert [option.name for option in command.params if not option.help] == []


def test_options_have_the_defaults_of_the_request(run: Run) -> None:
    _, out, _ = run("map", "--help")
    columns, rows = DEFAULT_RESOLUTION
    assert f"[default: {columns}x{rows}]" in out
    assert f"[default: {FigureStyle().dpi}]" in out


@pytest.mark.parametrize("before", [(), ("--json",), ("--json", "--")])
def test_formula_may_begin_with_a_minus(before: tuple[str, ...], run: Run) -> None:
    code, out, err = run("potential", *before, "-x^3/3+0.5(x^2+y^2)")
    assert (code, err) == (0, "")
    assert "x²/2 + y²/2 − x³/3" in out


def test_module_runs_as_a_program() -> None:
    command = [sys.executable, "-m", "cli", "lyapunov", next(iter(CASES)), "--energy", "one"]
    process = subprocess.run(command, cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False)
    assert (process.returncode, process.stdout, process.stderr.count("\n")) == (INVALID_REQUEST, "", 1)
