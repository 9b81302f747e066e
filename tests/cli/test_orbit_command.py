"""Command ``orbit`` prints verdicts, and writes table and picture of the engine's orbit."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from engine import CASES, POTENTIALS, Plane, find_lyapunov_orbits, integrate_orbit, judge_orbit, start_states
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits
from engine.trajectories.chaos_indicators import evaluate_indicators
from plots.pictures.palette import COLOUR_BLIND_SAFE
from plots.texts.exports import orbits_csv
from tests.cli.conftest import Run

STATE = (0.1, 0.0, 0.05, 0.6)


def test_csv_and_json_equal_the_engine_result(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("orbit", "I", "--state", *STATE, "--t-max", 100, "--json", "--output", tmp_path / "orbit.csv")
    result, orbit = json.loads(out), integrate_orbit(CASES["I"], STATE, 100.0)
    assert code == 0
    assert (tmp_path / "orbit.csv").read_text() == orbits_csv([orbit])
    assert (result["fate"], result["crossings"], result["energy"]) == (orbit.fate, orbit.crossings, orbit.energy)
    assert result["escape_time"] == (orbit.escape_time if orbit.fate >= 1 else None)
    verdict = judge_orbit(orbit)
    assert (result["verdict"], result["outcome"]) == (verdict.describe(), verdict.outcome)


@pytest.mark.parametrize(
    ("plane", "energy", "start"), [("x_px", 0.19, (0.1, -0.2)), ("x_y", 0.19, (-0.1, 0.2)), ("x_h", None, (0.2, 0.3))]
)
def test_start_on_a_plane_becomes_the_engine_state(
    plane: str, energy: float | None, start: tuple[float, float], run: Run
) -> None:
    at = () if energy is None else ("--energy", energy)
    _, out, _ = run("orbit", "I", "--plane", plane, *at, "--start", *start, "--t-max", 20, "--json")
    x, ordinate = np.array(start)[:, None]
    assert json.loads(out)["start"] == start_states(CASES["I"], Plane[plane.upper()], energy or 0.0, x, ordinate)[0].tolist()


def test_bounded_orbit_has_verdicts_of_all_indicators(run: Run, tmp_path: Path) -> None:
    state = (0.1, 0.0, 0.0, 0.4)
    code, out, _ = run("orbit", "III", "--state", *state, "--t-max", 2500, "--output", tmp_path / "orbit.csv")
    orbit = integrate_orbit(CASES["III"], state, 2500.0)
    digits = compute_birkhoff_digits(CASES["III"], state, 2500.0)
    verdicts = evaluate_indicators(orbit, digits)
    assert code == 0
    assert judge_orbit(orbit, digits).describe() in out
    assert judge_orbit(orbit, digits).describe() in (tmp_path / "orbit.csv").read_text()
    names = ["SALI", "Lyapunov exponent", "Birkhoff digits of halves", "Birkhoff digits"]
    assert [verdict.name for verdict in verdicts if verdict.sentence in out] == names


def test_no_files_without_output_option(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert run("orbit", "I", "--state", *STATE, "--t-max", 20)[0] == 0
    assert not any(tmp_path.iterdir())


def test_picture_shows_the_path(run: Run, tmp_path: Path) -> None:
    state = (0.1, 0.0, 0.0, 0.4)
    arguments = ("orbit", "III", "--state", *state, "--t-max", 1000, "--palette", "safe", "--output", tmp_path / "orbit")
    assert run(*arguments)[0] == 0
    colour = tuple(bytes.fromhex(COLOUR_BLIND_SAFE.orbits[0][1:]))
    with Image.open(tmp_path / "orbit.png") as image:
        inked = np.all(np.asarray(image.convert("RGB"))[:, : image.width // 2] == colour, axis=2)
    rows, columns = np.nonzero(inked)
    # The orbit stays near the y axis, the longer side of its bounding box.
    assert np.ptp(rows) > 1.5 * np.ptp(columns) > 0


def test_start_outside_writes_files(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("orbit", "II", "--state", 1.3, 0, 0.1, 0, "--output", tmp_path / "orbit")
    assert code == 0
    assert "Outside" in out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["orbit.crossings.csv", "orbit.csv", "orbit.png"]


def test_jacobi_constant_stands_for_the_energy_of_a_rotating_frame(run: Run) -> None:
    potential = POTENTIALS["Earth-Moon"]
    code, out, _ = run("lyapunov", "Earth-Moon", "--jacobi", 3.17, "--json")
    orbits = find_lyapunov_orbits(potential, potential.jacobi_energy(3.17))
    assert code == 0
    assert [(one["name"], one["period"]) for one in json.loads(out)["orbits"]] == [
        (name, pytest.approx(orbit.period)) for name, orbit in zip(("L2", "L1"), orbits, strict=True)
    ]


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (("Hill", "--energy", -2, "--jacobi", 4), "jacobi=4.0: give either --energy H or --jacobi C"),
        (("I", "--jacobi", 3), "potential=I: its frame must rotate"),
        (("I",), "energy: give --energy H, or --jacobi C in a rotating frame"),
    ],
)
def test_wrong_energies_are_refused(words: tuple[object, ...], problem: str, run: Run) -> None:
    code, _, err = run("lyapunov", *words)
    assert (code, problem in err) == (2, True)


def test_the_crossings_can_be_written_alone(run: Run, tmp_path: Path) -> None:
    code, _, _ = run("orbit", "I", "--state", *STATE, "--t-max", 100, "--output", tmp_path / "orbit.crossings.csv")
    assert code == 0
    assert [path.name for path in tmp_path.iterdir()] == ["orbit.crossings.csv"]
    assert "orbit,crossing,t,x,y,px,py" in (tmp_path / "orbit.crossings.csv").read_text()
