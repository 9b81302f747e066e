"""Channels merge into one exit above each maximum between them."""

from __future__ import annotations

import pytest

from engine.systems.merged_channels import ChannelMerger, MergedExit, exit_numbers, merged_exits, name_exit

MERGERS = (ChannelMerger(0.3, 0.0, 0.0, (1, 3)), ChannelMerger(0.5, 0.0, 0.0, (3, 4)))
RING = (*MERGERS, ChannelMerger(0.6, 0.0, 0.0, (2, 4)), ChannelMerger(0.7, 0.0, 0.0, (1, 2)))


@pytest.mark.parametrize(("energy", "expected"), [(0.3, ()), (0.4, ((1, 3),)), (0.6, ((1, 3, 4),))])
def test_channels_are_one_exit_above_each_maximum_between_them(energy: float, expected: tuple[tuple[int, ...], ...]) -> None:
    assert tuple(merged.channels for merged in merged_exits(MERGERS, energy)) == expected


def test_maxima_all_around_the_well_close_a_ring() -> None:
    assert merged_exits(RING, 0.65) == (MergedExit((1, 2, 3, 4), closes_ring=False),)
    assert merged_exits(RING, 0.75) == (MergedExit((1, 2, 3, 4), closes_ring=True),)


def test_a_merged_exit_has_the_lowest_number_of_its_channels() -> None:
    assert exit_numbers(MERGERS, 5).tolist() == [[0, 1, 2, 3, 4, 5], [0, 1, 2, 1, 4, 5], [0, 1, 2, 1, 1, 5]]


@pytest.mark.parametrize(
    ("channel", "low", "high", "expected"),
    [
        (1, 0.2, 0.2, "1"),
        (1, 0.4, 0.4, "1+3"),
        (3, 0.4, 0.4, "3 in 1+3"),
        (2, 0.2, 0.8, "2"),
        (1, 0.2, 0.8, "1, 1+3 above h = 0.3, 1+3+4 above h = 0.5"),
        (4, 0.4, 0.8, "4, 4 in 1+3+4 above h = 0.5"),
    ],
)
def test_names_of_merged_exits_tell_their_lowest_energy(channel: int, low: float, high: float, expected: str) -> None:
    assert name_exit(channel, MERGERS, low, high) == expected
