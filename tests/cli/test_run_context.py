"""A run that is cancelled gives no result."""

from __future__ import annotations

from concurrent.futures import CancelledError

import pytest

from cli.run_context import cancellable_run


def run_cancelled(*later_stages: str) -> None:
    """A run that Ctrl-C cancels before its later stages."""
    with cancellable_run() as run:
        assert run.execution.cancel is not None
        run.execution.cancel.set()
        for stage in later_stages:
            run.start_stage(stage)
            pytest.fail("a stage began")


@pytest.mark.parametrize("later_stages", [(), ("map",)])
def test_a_cancelled_run_raises(later_stages: tuple[str, ...]) -> None:
    with pytest.raises(CancelledError):
        run_cancelled(*later_stages)
