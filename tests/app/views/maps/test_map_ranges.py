"""Ranges report the window after a gesture, and end at double precision."""

from __future__ import annotations

import pytest
from bokeh.document import Document

from app.views.maps.map_ranges import MapRanges
from engine import CASES, MapSpec, Plane, Window

HOME = MapSpec(CASES["I"], Plane.X_PX, 0.19)


class RangesOnPage:
    """Ranges in a document, first at the window of the whole interior. Records what they report, and counts gestures."""

    def __init__(self) -> None:
        self.zooms: list[Window | None] = []
        self.ends = 0
        self.ranges = MapRanges(self.zooms.append, self._end)
        self.home = HOME.find_window()
        self.document = Document()
        self.document.add_root(self.ranges.x)
        self.ranges.follow(self.home)

    def _end(self) -> None:
        self.ends += 1

    def answer(self) -> None:
        """Answer the last move of the server as a browser does."""
        self.ranges.ordinate.tags = self.ranges.x.tags


def test_reversed_ranges_do_not_give_a_window() -> None:
    zooms: list[Window | None] = []
    ranges = MapRanges(zooms.append, lambda: None)
    ranges.follow(HOME.find_window())
    for start, end in ((0.2, 0.1), (0.1, 0.2)):
        ranges.x.update(start=start, end=end)
        ranges.end_gesture()
    assert [(zoom.x_low, zoom.x_high) for zoom in zooms if zoom] == [(0.1, 0.2)]


def test_the_window_of_the_whole_interior_is_no_zoom() -> None:
    zooms: list[Window | None] = []
    ranges = MapRanges(zooms.append, lambda: None)
    ranges.set_home(HOME)
    home = HOME.find_window()
    ranges.follow(Window(0.1, 0.2, 0.1, 0.2))
    ranges.x.update(start=home.x_low, end=home.x_high)
    ranges.ordinate.update(start=home.ordinate_low, end=home.ordinate_high)
    ranges.end_gesture()
    assert zooms == [None]


@pytest.mark.parametrize("corner", [(0.0, 0.0), (0.1149, 0.3006), (-0.45, -0.4)])
def test_the_smallest_window_can_be_computed_and_a_tenth_of_it_cannot(corner: tuple[float, float]) -> None:
    ranges = MapRanges(lambda window: None, lambda: None)
    ranges.set_home(HOME)

    def window(share: float) -> Window:
        x, ordinate = corner
        return Window(x, x + share * ranges.x.min_interval, ordinate, ordinate + share * ranges.ordinate.min_interval)

    smallest = window(1.0)
    assert MapSpec(HOME.potential, HOME.plane, HOME.energy, window=smallest).find_window() == smallest
    with pytest.raises(ValueError, match="double precision ends here"):
        MapSpec(HOME.potential, HOME.plane, HOME.energy, window=window(0.1)).find_window()


def test_a_chosen_window_drops_a_move_that_is_not_reported() -> None:
    page = RangesOnPage()
    ranges, home = page.ranges, page.home
    ranges.x.start = 0.5 * home.x_low
    assert len(page.document.session_callbacks) == 1
    ranges.go_to(home)
    assert not page.document.session_callbacks
    ranges.end_gesture()
    assert page.zooms == []
    assert ranges.x.start == home.x_low


def test_a_move_that_the_browser_makes_before_it_has_the_window_is_undone() -> None:
    page = RangesOnPage()
    ranges, closer = page.ranges, Window(-0.1, 0.1, -0.1, 0.1)

    def move_closer() -> None:
        ranges.x.update(start=-0.05, end=0.05)
        ranges.end_gesture()

    page.answer()
    ranges.go_to(closer)
    move_closer()
    assert page.zooms == []
    page.answer()
    assert ranges.x.end == closer.x_high
    page.answer()
    move_closer()
    assert [zoom.x_high for zoom in page.zooms if zoom] == [0.05]


def test_a_window_that_is_shown_late_does_not_undo_later_gestures() -> None:
    page = RangesOnPage()
    ranges = page.ranges
    ranges.x.update(start=-0.2, end=0.2)
    ranges.end_gesture()
    [reported] = page.zooms
    assert reported is not None
    ranges.ordinate.update(start=-0.1, end=0.1)
    ranges.go_to(reported)
    ranges.finish_report()
    assert ranges.ordinate.end == 0.1
    [timer] = page.document.session_callbacks
    timer.callback()
    assert page.zooms[-1] == Window(-0.2, 0.2, -0.1, 0.1)


def test_ranges_do_not_follow_an_earlier_map_before_their_window_is_shown() -> None:
    page = RangesOnPage()
    ranges, home = page.ranges, page.home
    ranges.x.update(start=-0.2, end=0.2)
    ranges.end_gesture()
    ranges.follow(home)
    assert ranges.x.end == 0.2
    # The server has refused the window.
    ranges.finish_report()
    assert ranges.x.end == home.x_high


def test_a_timer_that_is_due_when_the_ranges_move_on_reports_nothing() -> None:
    page = RangesOnPage()
    ranges = page.ranges
    ranges.x.start = -0.1
    [timer] = page.document.session_callbacks
    ranges.x.end = 0.1
    # Bokeh calls a timer that is due even so, once the message that moved the ranges has released the lock.
    timer.callback()
    assert page.zooms == []
    [timer] = page.document.session_callbacks
    timer.callback()
    assert [(zoom.x_low, zoom.x_high) for zoom in page.zooms if zoom] == [(-0.1, 0.1)]


def test_a_step_within_the_pause_belongs_to_the_same_gesture() -> None:
    page = RangesOnPage()
    ranges = page.ranges
    ranges.end_gesture()
    [pause] = page.document.session_callbacks
    ranges.x.start = -0.1
    pause.callback()
    assert page.ends == 0
    ranges.end_gesture()
    [pause] = page.document.session_callbacks
    pause.callback()
    assert page.ends == 1


def test_the_magnification_is_that_of_the_width() -> None:
    ranges = MapRanges(lambda window: None, lambda: None)
    ranges.set_home(HOME)
    home = HOME.find_window()
    ranges.follow(Window(0.0, 0.01 * (home.x_high - home.x_low), 0.0, 0.1))
    assert ranges.magnification == pytest.approx(100.0)
