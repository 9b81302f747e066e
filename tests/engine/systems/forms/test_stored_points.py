"""Critical points are stored on disk, and damaged files are replaced."""

from __future__ import annotations

import logging
from pathlib import Path

import numpy as np
import pytest

from engine.foundations.cache_files import CACHE_VARIABLE
from engine.systems.forms.stored_points import stored_points

TERMS = {(2, 0): 0.5, (0, 2): 0.5}
POINTS = np.array([[0.0, 0.1 + 0.2]])


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    return tmp_path / "kernels"


def never() -> np.ndarray:
    raise AssertionError


def test_points_found_before_are_read_bit_by_bit() -> None:
    np.testing.assert_array_equal(stored_points("points", TERMS, lambda: POINTS), POINTS)
    np.testing.assert_array_equal(stored_points("points", TERMS, never), POINTS)


def test_other_terms_or_another_order_of_the_terms_have_their_own_points() -> None:
    stored_points("points", TERMS, lambda: POINTS)
    for other in ({**TERMS, (3, 0): 1.0}, dict(reversed(TERMS.items()))):
        assert stored_points("points", other, lambda: 2.0 * POINTS)[0, 1] == 2.0 * POINTS[0, 1]


def test_a_damaged_file_is_replaced_with_a_warning(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    stored_points("points", TERMS, lambda: POINTS)
    (file,) = folder.iterdir()
    file.write_bytes(file.read_bytes()[:-1])
    with caplog.at_level(logging.WARNING):
        np.testing.assert_array_equal(stored_points("points", TERMS, lambda: POINTS), POINTS)
    assert "invalid points" in caplog.text
    np.testing.assert_array_equal(stored_points("points", TERMS, never), POINTS)
