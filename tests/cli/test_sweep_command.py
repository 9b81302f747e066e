"""Command ``sweep`` writes the engine's results to a store, and resumes after an interruption."""

from __future__ import annotations

import json
import signal
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import engine
from cli.main import INTERRUPTED
from engine import CASES, Execution, ParameterAxis, Plane, SweepSpec
from engine.results import Sweep
from tests.cli.conftest import Run

SWEEP = ("sweep", "I", "--low", 0.13, "--high", 0.2, "--count", 3, "--resolution", "9x7", "--t-max", 50)
SPEC = SweepSpec(CASES["I"], Plane.X_PX, tuple(np.linspace(0.13, 0.2, 3).tolist()), (9, 7), t_max=50.0)


def load(store: Path) -> xr.Dataset:
    return xr.open_zarr(store, chunks=None).load()


def test_store_equals_the_maps_of_the_engine(run: Run, tmp_path: Path) -> None:
    code, out, _ = run(*SWEEP, "--json", "--store", tmp_path / "store.zarr")
    found = load(tmp_path / "store.zarr")
    assert (code, json.loads(out)["dimensions"]) == (0, {"h": 3, "px": 7, "x": 9})
    for place, energy in enumerate(SPEC.values):
        np.testing.assert_array_equal(found["escape_time"][place], engine.compute_map(SPEC.point(energy).map_spec).escape_time)


def test_listed_energies_equal_spaced_ones(run: Run, tmp_path: Path) -> None:
    listed = [argument for energy in SPEC.values for argument in ("--energy", energy)]
    run("sweep", "I", *listed, "--resolution", "9x7", "--t-max", 50, "--store", tmp_path / "listed.zarr")
    run(*SWEEP, "--store", tmp_path / "spaced.zarr")
    xr.testing.assert_identical(load(tmp_path / "listed.zarr"), load(tmp_path / "spaced.zarr"))


def test_a_store_can_hold_measures_alone(run: Run, tmp_path: Path) -> None:
    run(*SWEEP, "--measure", "shares", "--measure", "islands", "--store", tmp_path / "store.zarr")
    wanted = engine.compute_sweep(replace(SPEC, measures=("shares", "islands"))).dataset
    xr.testing.assert_equal(load(tmp_path / "store.zarr"), wanted)


PLATE = ("sweep", "I", "--axis", "omega_1=0.9:1.1:2", "--axis", "epsilon=0.8:1.2:3", "--energy", 0.2, "--measure", "shares")


def test_a_store_can_have_two_axes(run: Run, tmp_path: Path) -> None:
    code, out, _ = run(*PLATE, "--resolution", "9x7", "--t-max", 50, "--json", "--store", tmp_path / "store.zarr")
    assert (code, json.loads(out)["dimensions"]) == (0, {"omega_1": 2, "epsilon": 3, "outcome": 3})
    axes = ParameterAxis("omega_1", 0.9, 1.1, CASES["I"]), ParameterAxis("epsilon", 0.8, 1.2, CASES["I"])
    spec = replace(SPEC, values=((0.9, 1.1), np.linspace(0.8, 1.2, 3)), along=axes, energy=0.2, measures=("shares",))
    xr.testing.assert_equal(load(tmp_path / "store.zarr"), engine.compute_sweep(spec).dataset)


def test_one_axis_of_jacobi_constants(run: Run, tmp_path: Path) -> None:
    arguments = ("--axis", "jacobi=4.1:4.3:2", "--measure", "shares", "--resolution", "9x7", "--t-max", 20)
    assert run("sweep", "Hill", *arguments, "--store", tmp_path / "store.zarr")[0] == 0
    assert load(tmp_path / "store.zarr")["jacobi"].values.tolist() == [4.1, 4.3]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--axis", "epsilon=0.8:1.2"), "axis='epsilon=0.8:1.2': must be NAME=LOW:HIGH:COUNT"),
        (("--axis", "epsilon=0.8:1.2:3", "--low", 0.1), "axis: must be given without --low"),
        (("--axis", "epsilon=0.8:1.2:3", "--energy", 0.1, "--energy", 0.2), "axis: must be given without --low"),
        (("--axis", "width=0.8:1.2:3", "--energy", 0.2), "parameter 'width': must be a parameter of the system"),
        (("--axis", "h=0.2:0.1:3",), "low=0.2, high=0.1: low must be below high"),
    ],
)  # fmt: skip
def test_wrong_axes_are_refused(run: Run, tmp_path: Path, arguments: tuple[object, ...], message: str) -> None:
    code, _, err = run("sweep", "I", *arguments, "--store", tmp_path / "store.zarr")
    assert code == 2
    assert message in " ".join(err.split())


def test_interrupted_sweep_is_resumed(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(spec: SweepSpec, store: Path, *, execution: Execution) -> Sweep:
        def stop_later(share: float) -> None:
            if share >= 1 / 3 and not execution.is_cancelled:
                signal.raise_signal(signal.SIGINT)

        return engine.compute_sweep(spec, store, execution=replace(execution, on_progress=stop_later))

    store = tmp_path / "store.zarr"
    with monkeypatch.context() as patch:
        patch.setattr("cli.commands.sweep.compute_sweep", interrupted)
        code, out, err = run(*SWEEP, "--store", store)
    assert (code, out) == (INTERRUPTED, "")
    assert f"are kept in {store}" in err
    assert load(store)["h"].values.tolist() == [0.13]
    assert run(*SWEEP, "--store", store)[0] == 0
    assert load(store)["h"].values.tolist() == list(SPEC.values)


def test_a_plan_as_json_has_the_numbers_of_the_plan(run: Run, tmp_path: Path) -> None:
    code, out, _ = run(*SWEEP, "--plan", "--json", "--store", tmp_path / "store.zarr")
    assert code == 0
    plan = json.loads(out)
    assert plan["orbits"] == 3 * 9 * 7
    assert plan.keys() == {"orbits", "seconds", "bytes", "cores"}


def test_option_plan_computes_nothing(run: Run, tmp_path: Path) -> None:
    code, out, _ = run(*SWEEP, "--plan", "--store", tmp_path / "store.zarr")
    assert (code, out.count("\n")) == (0, 1)
    assert "189 orbits" in out
    assert not any(tmp_path.iterdir())
