"""Exits of several channels. At energies above a maximum of V between channels, no wall separates them: they form one exit.

The number of such an exit is the lowest number of its channels. The name of the exit contains all numbers: "1+3".
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np


class ChannelMerger(NamedTuple):
    """A maximum of V at (x, y). At energies above its value `energy`, the `channels` around it form one exit."""

    energy: float
    x: float
    y: float
    channels: tuple[int, ...]


class MergedExit(NamedTuple):
    """The numbers, in increasing order, of two or more channels that form one exit, and whether the exit surrounds the well."""

    channels: tuple[int, ...]
    closes_ring: bool

    @property
    def name(self) -> str:
        """Name of the exit, such as "1+3"."""
        return name_channels(self.channels)


def name_channels(channels: Sequence[int], names: Sequence[str] = ()) -> str:
    """Return the name of an exit, made of the names of its channels, by default their numbers: "1" or "1+3"."""
    return "+".join(names[channel - 1] if names else str(channel) for channel in channels)


def merged_exits(mergers: Sequence[ChannelMerger], energy: float) -> tuple[MergedExit, ...]:
    """Return the exits of several channels at an energy, the lowest number first."""
    connected_channels = [merger.channels for merger in mergers if energy > merger.energy]
    groups: list[set[int]] = []
    for channels in connected_channels:
        joined_groups = [group for group in groups if not group.isdisjoint(channels)]
        groups = [group for group in groups if group not in joined_groups] + [set(channels).union(*joined_groups)]
    # A maximum among n channels connects them n − 1 times. A ring has at least as many connections as channels.
    connections = [sum(len(channels) - 1 for channels in connected_channels if group.issuperset(channels)) for group in groups]
    return tuple(
        sorted(MergedExit(tuple(sorted(group)), count >= len(group)) for group, count in zip(groups, connections, strict=True))
    )


def exit_numbers(mergers: Sequence[ChannelMerger], outcome_count: int) -> np.ndarray:
    """Return the exit numbers of outcomes, int8, of shape (mergers + 1, outcome_count + 1).

    Row k is for energies above the lowest k mergers, and column n for the outcome with fate n. `mergers` are sorted by energy.
    """
    numbers = np.tile(np.arange(outcome_count + 1, dtype=np.int8), (len(mergers) + 1, 1))
    for k in range(len(mergers)):
        for merged in merged_exits(mergers[: k + 1], np.inf):
            numbers[k + 1, list(merged.channels)] = merged.channels[0]
    return numbers


def name_exit(channel: int, mergers: Sequence[ChannelMerger], low: float, high: float, names: Sequence[str] = ()) -> str:
    """Return the name of the exit to which a channel belongs at the energies from `low` to `high`.

    A separate channel is "1". In an exit of several channels, the lowest channel is "1+3", and another is "3 in 1+3". For a range
    of energies, the name can be "1, 1+3 above h = 0.3". By default, the name of a channel is its number.
    """
    changes = [(low, _name_exit_at(channel, mergers, low, names))]
    for energy in sorted(merger.energy for merger in mergers if low <= merger.energy < high):
        name = _name_exit_at(channel, mergers, np.nextafter(energy, np.inf), names)
        if name != changes[-1][1]:
            changes.append((energy, name))
    return ", ".join([changes[0][1], *(f"{name} above h = {energy:.6g}" for energy, name in changes[1:])])


def _name_exit_at(channel: int, mergers: Sequence[ChannelMerger], energy: float, names: Sequence[str]) -> str:
    """Return the name at one energy, see `name_exit`."""
    channel_name = name_channels([channel], names)
    for merged in merged_exits(mergers, energy):
        if channel in merged.channels:
            exit_name = name_channels(merged.channels, names)
            return exit_name if channel == merged.channels[0] else f"{channel_name} in {exit_name}"
    return channel_name
