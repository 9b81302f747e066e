"""Any command line either runs or prints one line to stderr and returns a documented exit code."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cli.main import FAILED, INVALID_REQUEST, main
from tests.fuzz.hostile import EXTREMES, limited_resources, texts

SMALL = {
    "map": ("map", "I", "--energy", "0.19", "--resolution", "4", "--t-max", "5", "--format", "nc"),
    "orbit": ("orbit", "I", "--energy", "0.19", "--start", "0.1", "0.1", "--t-max", "20"),
    "lyapunov": ("lyapunov", "I", "--energy", "0.19"),
    "measures": ("measures", "I", "--energy", "0.19", "--resolution", "12", "--t-max", "10", "--no-exponent"),
    "curves": (
        "curves", "I", "--low", "0.18", "--high", "0.19", "--count", "2", "--resolution", "6", "--t-max", "5", "--no-exponent",
    ),
    "potential": ("potential", "C5@epsilon=0.8", "--json"),
    "sweep": ("sweep", "I", "--energy", "0.19", "--resolution", "4", "--t-max", "5", "--store", "store.zarr"),
}  # fmt: skip
FLAGS = (
    "--backward", "--no-evidence", "--json", "--origins", "--window", "--energies", "--state", "--palette", "--picture",
    "--output", "--plane", "--manifolds", "--threads", "--most-rows", "--width", "--unknown", "--", "-",
)  # fmt: skip
CHEAP_NUMBERS = [repr(number) for number in EXTREMES if not 20.0 < number < 1e300]


def as_argument(text: str) -> str:
    """Replace a surrogate by that which Python uses for undecodable bytes of an argument, and shorten long text."""
    return text[:200].replace("\ud800", "\udcff")


words = texts.map(as_argument) | st.sampled_from(CHEAP_NUMBERS)


@pytest.fixture(scope="module", autouse=True)
def temporary_working_directory(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with contextlib.chdir(tmp_path_factory.mktemp("cli")):
        yield


def run(arguments: list[str]) -> None:
    out, err = io.StringIO(), io.StringIO()
    parent_files = set(Path("..").iterdir())
    with limited_resources(), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(arguments)
    assert code in (0, INVALID_REQUEST, FAILED), (code, err.getvalue())
    if code:
        message = err.getvalue()
        assert message.startswith("escape-explorer: "), message
        assert message.count("\n") == 1, message
        # Unexpected exceptions are printed with the name of their class.
        assert "Error: " not in message.partition(":")[2][:30] or "OSError" in message, f"{arguments}: {message}"
    assert set(Path("..").iterdir()) == parent_files
    assert not [path for path in Path().iterdir() if path.name.endswith(".part")]


@pytest.mark.parametrize("command", SMALL)
@given(st.data())
@settings(suppress_health_check=[HealthCheck.too_slow], max_examples=5)
def test_a_command_with_other_arguments_runs_or_is_refused_in_one_line(command: str, data: st.DataObject) -> None:
    arguments = list(SMALL[command])
    if data.draw(st.booleans()):
        arguments[data.draw(st.integers(1, len(arguments) - 1))] = data.draw(words)
    run([*arguments, *data.draw(st.lists(st.sampled_from(FLAGS) | words, max_size=3))])
