"""Links contain the image of the manifolds and the locked scale of escape times."""

from __future__ import annotations

import pytest

from app.state.permalink import read_link, write_link
from app.state.view_state import ViewState
from plots.time_scale import TimeScale


def test_defaults_are_left_out() -> None:
    link = write_link(ViewState())
    assert "images" not in link
    assert "lock_times" not in link


def test_an_image_is_in_the_link() -> None:
    assert "images=2" in write_link(ViewState(images=2))
    assert read_link({"images": "2"}) == ({"images": 2}, [])
    assert read_link({"images": "all"}) == ({"images": 0}, [])


def test_a_locked_scale_is_in_the_link_as_two_numbers() -> None:
    scale = TimeScale(0.5, 2000.0)
    assert "lock_times=0.5,2000" in write_link(ViewState(lock_times=scale))
    assert read_link({"lock_times": "0.5,2000"}) == ({"lock_times": scale}, [])


def test_a_single_number_is_the_upper_end_of_the_scale() -> None:
    assert read_link({"lock_times": "2000"}) == ({"lock_times": TimeScale(1.0, 2000.0)}, [])


@pytest.mark.parametrize(
    ("name", "text"), [("images", "4"), ("images", "0"), *(("lock_times", text) for text in ("1", "nan", "9,2", "1,2,3"))]
)
def test_invalid_values_are_ignored_with_a_message(name: str, text: str) -> None:
    values, problems = read_link({name: text})
    assert values == {}
    assert len(problems) == 1
