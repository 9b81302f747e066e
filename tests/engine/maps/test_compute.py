"""Maps computed in blocks of rows are the same as maps computed at once."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engine import CASES, EscapeMap, Execution, Fate, MapSpec, Plane, compute_map, open_result
from engine.maps.compute import LARGEST_RUN, BlockwiseRun, row_blocks
from engine.maps.result import PIXEL_ARRAYS
from engine.maps.stages import run_stages

SPECS = [
    MapSpec(CASES["III"], Plane.X_PX, 0.4, (30, 31), t_max=300.0),
    MapSpec(CASES["II"], Plane.X_H, (0.17, 0.4), (20, 33), t_max=300.0),
]


@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: spec.plane.title)
def test_map_computed_in_blocks_is_bit_identical(spec: MapSpec) -> None:
    shares: list[float] = []
    work = BlockwiseRun(spec.in_well_units(), 150)
    run_stages(work, Execution(on_progress=shares.append))
    in_blocks, whole = work.result().restored(spec), compute_map(spec)
    assert in_blocks.complete
    for name in PIXEL_ARRAYS:
        np.testing.assert_array_equal(getattr(in_blocks, name), getattr(whole, name), err_msg=name)
    assert len(shares) >= 5
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_cancelled_blocks_hold_what_is_computed_so_far() -> None:
    cancel = threading.Event()
    work = BlockwiseRun(SPECS[0].in_well_units(), 150)
    run_stages(work, Execution(cancel=cancel, on_progress=lambda _share: cancel.set()))
    result = work.result()
    assert not result.complete
    assert np.any(result.fate >= 1)
    assert np.any(result.fate == Fate.NOT_COMPUTED)


@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: spec.plane.title)
def test_blocks_that_are_resumed_from_a_file_are_bit_identical(tmp_path: Path, spec: MapSpec) -> None:
    cancel = threading.Event()
    begun = BlockwiseRun(spec.in_well_units(), 150)
    run_stages(begun, Execution(cancel=cancel, on_progress=lambda share: cancel.set() if share > 0.3 else None))
    begun.result().restored(spec).save(tmp_path / "map.nc")
    earlier = open_result(tmp_path / "map.nc", EscapeMap)
    assert not earlier.complete
    shares: list[float] = []
    resumed = BlockwiseRun(spec.in_well_units(), 150, earlier.in_well_units())
    run_stages(resumed, Execution(on_progress=shares.append))
    assert shares[0] > 0.3
    in_blocks, whole = resumed.result().restored(spec), compute_map(spec)
    for name in PIXEL_ARRAYS:
        np.testing.assert_array_equal(getattr(in_blocks, name), getattr(whole, name), err_msg=name)


def test_a_large_map_is_resumed_from_a_frame_of_the_same_request() -> None:
    # All starts are forbidden, which takes no time.
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.4, (1024, LARGEST_RUN // 1024 + 1), (5.0, 6.0, 5.0, 6.0))
    frames: list[EscapeMap] = []
    compute_map(spec, frames.append)
    assert compute_map(spec, resume=frames[0]).complete
    with pytest.raises(ValueError, match="resume: a map with another t_max; must be equal for more than 2²⁰ pixels"):
        compute_map(replace(spec, t_max=2.0 * spec.t_max), resume=frames[0])


def test_a_map_from_a_file_is_not_resumed_and_the_message_names_store(tmp_path: Path) -> None:
    compute_map(SPECS[0]).save(tmp_path / "map.nc")
    with pytest.raises(ValueError, match=r"maps from files have no integration state; .*, or use store to continue from a file"):
        compute_map(SPECS[0], resume=open_result(tmp_path / "map.nc", EscapeMap))


def test_a_large_map_is_computed_in_blocks_which_keep_no_states() -> None:
    columns = 1024
    rows = LARGEST_RUN // columns + 1
    # All starts are forbidden, which takes no time.
    large = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.4, (columns, rows), (5.0, 6.0, 5.0, 6.0)))
    assert large.complete
    assert large.batch is None


def test_frames_cancellation_and_executor_may_be_given_by_position() -> None:
    frames: list[EscapeMap] = []
    cancel = threading.Event()
    cancel.set()
    with ThreadPoolExecutor(1) as pool:
        assert compute_map(SPECS[0], frames.append, None, pool).complete
        assert frames[-1].complete
        assert not compute_map(SPECS[0], None, cancel, pool).complete


def test_arguments_beside_an_execution_replace_its_fields() -> None:
    cancelled = threading.Event()
    cancelled.set()
    shares: list[float] = []
    result = compute_map(SPECS[0], cancel=cancelled, execution=Execution(on_progress=shares.append))
    assert not result.complete
    assert compute_map(SPECS[0], execution=Execution(on_progress=shares.append)).complete
    assert shares[-1] == 1.0


@pytest.mark.parametrize("max_pixels", [1, 150])
@pytest.mark.parametrize("rows", [30, 31])
def test_blocks_contain_each_row_once_with_its_mirror_image(rows: int, max_pixels: int) -> None:
    blocks = list(row_blocks(MapSpec(CASES["III"], Plane.X_PX, 0.4, (30, rows)), max_pixels))
    np.testing.assert_array_equal(np.sort(np.concatenate(blocks)), np.arange(rows))
    for block in blocks:
        assert block.size <= max(max_pixels // 30, 2)
        np.testing.assert_array_equal(block, np.sort(rows - 1 - block))
