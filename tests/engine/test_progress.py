from __future__ import annotations

import threading

import pytest

from engine import CASES, MapSpec, Plane, compute_map, compute_regularity, compute_trust
from engine import progress as bars
from engine.progress import shows_progress

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.36, (24, 24), t_max=200.0)


@shows_progress("test")
def long_call(*, on_frame: object = None, on_progress: object = None) -> object:
    return on_progress


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)


@pytest.mark.usefixtures("terminal")
class TestBar:
    def test_is_shown_in_a_terminal(self) -> None:
        assert callable(long_call())

    def test_is_not_shown_beside_other_reports(self) -> None:
        assert long_call(on_frame=print) is None
        assert long_call(on_progress=print) is print

    def test_is_not_shown_by_other_threads(self) -> None:
        found: list[object] = []
        thread = threading.Thread(target=lambda: found.append(long_call()))
        thread.start()
        thread.join()
        assert found == [None]

    def test_calls_within_a_call_show_none(self) -> None:
        with bars._bar("outer"):
            assert long_call() is None


def test_without_a_terminal_there_is_no_bar() -> None:
    assert long_call() is None


def test_progress_rises_to_one_and_changes_no_result() -> None:
    shares: list[float] = []
    found = compute_map(SPEC, on_progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert (found.fate == compute_map(SPEC).fate).all()


def test_analyses_report_progress() -> None:
    found = compute_map(SPEC)
    for analyse in (compute_trust, compute_regularity):
        shares: list[float] = []
        analyse(found, on_progress=shares.append)
        assert shares[-1] == 1.0
