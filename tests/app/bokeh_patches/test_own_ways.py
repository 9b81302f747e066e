"""Ours in the place of Bokeh's."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from app.bokeh_patches.own_ways import put_in_place


def test_ours_takes_the_place() -> None:
    owner = SimpleNamespace(way="theirs", __name__="owner")
    put_in_place(owner, "way", "ours")
    assert owner.way == "ours"


def test_a_place_that_is_gone_stays_so_and_is_told_of(caplog: pytest.LogCaptureFixture) -> None:
    owner = SimpleNamespace(__name__="owner")
    put_in_place(owner, "way", "ours")
    assert not hasattr(owner, "way")
    assert "owner.way" in caplog.text
