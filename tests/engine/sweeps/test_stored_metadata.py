"""A store whose metadata have changed is refused, and only its complete values are read."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import zarr

from engine import CASES, Plane, SweepSpec, compute_sweep, open_result

SPEC = SweepSpec(CASES["III"], Plane.X_PX, (0.3, 0.4), (12, 10), t_max=300.0, measures=("maps", "shares"))


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the store of `SPEC`, which tests must not change."""
    store = tmp_path_factory.mktemp("finished") / "store"
    compute_sweep(SPEC, store)
    return store


@pytest.fixture
def store(tmp_path: Path, finished: Path) -> Path:
    """Return a copy of the store of `SPEC`."""
    return shutil.copytree(finished, tmp_path / "store")


@pytest.mark.parametrize(
    ("file", "earlier", "later"),
    [
        ("zarr.json", "exit 2", "exit 3"),
        ("fate/zarr.json", '"fill_value": -3', '"fill_value": 0'),
        ("share/zarr.json", '"NaN"', "0.5"),
    ],
)
def test_a_store_with_changed_metadata_is_refused(store: Path, file: str, earlier: str, later: str) -> None:
    text = (store / file).read_text()
    (store / file).write_text(text.replace(earlier, later, 1))
    assert earlier in text
    message = r"store: its files zarr\.json have been changed or damaged; restore them, or delete the folder"
    with pytest.raises(ValueError, match=f"store={store.parent}/{message}"):
        compute_sweep(SPEC, store)
    with pytest.raises(ValueError, match=f"path={store.parent}/{message}"):
        open_result(store)


def lengthen(store: Path, names: Iterable[str]) -> None:
    """Lengthen arrays as for another value, whose data are not written."""
    for name in names:
        array = zarr.open_array(store / name)
        array.resize((3, *array.shape[1:]))


def test_a_store_to_which_a_value_is_being_added_says_so(store: Path) -> None:
    lengthen(store, ["h"])
    with pytest.raises(ValueError, match=r"path=.*store: a value is being added, or .*; read it later"):
        open_result(store)


def test_values_that_are_not_complete_are_not_read(store: Path) -> None:
    whole = compute_sweep(SPEC).dataset
    lengthen(store, [str(name) for name, array in whole.variables.items() if "h" in array.dims])
    assert zarr.open_array(store / "h").shape == (3,)
    xr.testing.assert_identical(open_result(store).dataset, whole)
    xr.testing.assert_identical(compute_sweep(SPEC, store).dataset, whole)
    assert zarr.open_array(store / "h").shape == (2,)


def test_a_store_before_its_first_value_is_a_sweep_without_values(store: Path) -> None:
    zarr.open_group(store).attrs["finished"] = 0
    assert open_result(store).values.size == 0


def test_a_lost_value_of_the_axis_is_named(store: Path) -> None:
    (store / "h" / "c" / "1").unlink()
    with pytest.raises(ValueError, match=r"path=.*store: .*values of h are missing"):
        open_result(store)
    assert np.isfinite(compute_sweep(SPEC, store).values).all()


def test_data_that_are_damaged_are_not_read(store: Path) -> None:
    chunk = store / "share" / "c" / "1" / "0"
    content = bytearray(chunk.read_bytes())
    content[-6] ^= 1
    chunk.write_bytes(content)
    opened = open_result(store)
    with pytest.raises(ValueError, match="checksum do not match"):
        opened.dataset["share"].load()
