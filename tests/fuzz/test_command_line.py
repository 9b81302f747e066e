"""What can be typed: every command answers, or refuses in one line with an exit code of its own."""

from __future__ import annotations

import contextlib
import io
import os
import resource
import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cli.main import STOPPED, WENT_WRONG, WRONG_REQUEST, main
from tests.fuzz.hostile import EXTREMES, MOST_BYTES, MOST_SECONDS, case_strings, texts

SMALL = {
    "map": ("map", "I", "--energy", "0.19", "--resolution", "4", "--t-max", "5", "--side", "120", "--format", "nc"),
    "orbit": ("orbit", "I", "--energy", "0.19", "--start", "0.1", "0.1", "--t-max", "20"),
    "lyapunov": ("lyapunov", "I", "--energy", "0.19"),
    "measures": ("measures", "I", "--energy", "0.19", "--resolution", "12", "--t-max", "10", "--no-exponent"),
    "curves": (
        "curves",
        "I",
        "--low",
        "0.18",
        "--high",
        "0.19",
        "--count",
        "2",
        "--resolution",
        "6",
        "--t-max",
        "5",
        "--no-exponent",
    ),
    "potential": ("potential", "C5@epsilon=0.8", "--json"),
    "sweep": ("sweep", "I", "--energy", "0.19", "--resolution", "4", "--t-max", "5", "--store", "store.zarr"),
}
FLAGS = (
    "--backward", "--no-certify", "--json", "--origins", "--window", "--energies", "--state", "--palette", "--picture",
    "--output", "--plane", "--manifolds", "--threads", "--most-rows", "--side", "--unknown", "--", "-",
)  # fmt: skip
HARMLESS_NUMBERS = [repr(number) for number in EXTREMES if not 20.0 < number < 1e300]


def as_handed_over(text: str) -> str:
    """Surrogates stand for bytes that are no text: that is how Python hands them over."""
    return text[:200].replace("\ud800", "\udcff")


words = texts.map(as_handed_over) | st.sampled_from(HARMLESS_NUMBERS)


@pytest.fixture(scope="module", autouse=True)
def in_a_folder_of_its_own(tmp_path_factory: pytest.TempPathFactory) -> None:
    os.chdir(tmp_path_factory.mktemp("typed"))


def run(arguments: list[str]) -> None:
    out, err = io.StringIO(), io.StringIO()
    begun = time.process_time()
    around = set(Path("..").iterdir())
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(arguments)
    assert code in (0, WRONG_REQUEST, WENT_WRONG), (code, err.getvalue())
    assert code != STOPPED
    if code:
        said = err.getvalue()
        assert said.startswith("escape-explorer: "), said
        assert said.count("\n") == 1, said
        assert "Error: " not in said.partition(":")[2][:30] or "OSError" in said, f"{arguments}: {said}"
    assert set(Path("..").iterdir()) == around
    assert not [path for path in Path().iterdir() if path.name.endswith(".part")]
    assert time.process_time() - begun < MOST_SECONDS
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 < MOST_BYTES


@given(st.sampled_from(list(SMALL)), st.data())
@settings(suppress_health_check=[HealthCheck.too_slow])
def test_one_word_is_another(command: str, data: st.DataObject) -> None:
    arguments = list(SMALL[command])
    arguments[data.draw(st.integers(1, len(arguments) - 1))] = data.draw(words)
    run(arguments)


@given(st.sampled_from(list(SMALL)), st.lists(st.sampled_from(FLAGS) | words, max_size=4))
@settings(suppress_health_check=[HealthCheck.too_slow])
def test_more_words(command: str, more: list[str]) -> None:
    run([*SMALL[command], *more])


@given(case_strings)
@settings(suppress_health_check=[HealthCheck.too_slow])
def test_a_potential_by_name_or_formula(case: str) -> None:
    run(["potential", as_handed_over(case)])


@given(st.lists(st.sampled_from([*SMALL, *FLAGS]) | words, max_size=5).filter(lambda typed: "serve" not in typed))
def test_anything_at_all(arguments: list[str]) -> None:
    run(arguments)
