"""Compare fates of starts with those of their mirror images and rotated images, where V has the symmetry."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from engine import Fate, Potential, find_lyapunov_orbits
from tests.referee.report import COMPARED, UNDECIDED, Report
from tests.referee.setting import DURATION, STEADY, Setting

CHECK = "images"
STARTS = 60
# Largest relative difference of the times of images, and largest difference in units of the change of the time by a shift.
_LARGEST_DIFFERENCE, _PER_CHANGE = 1e-9, 1e-3


def _rotation(n: int) -> np.ndarray:
    turn = 2.0 * np.pi / n
    return np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])


IMAGES: Mapping[str, np.ndarray] = {
    "mirrored in x": np.diag([-1.0, 1.0]),
    "mirrored in y": np.diag([1.0, -1.0]),
    **{f"turned by 1/{n}": _rotation(n) for n in (2, 3, 4, 5, 7)},
}
"""Matrices (2, 2) that may leave V unchanged."""


def image_of(states: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Return the images of states (n, 4) under a matrix (2, 2)."""
    return np.hstack([states[:, :2] @ matrix.T, states[:, 2:] @ matrix.T])


def check_images(setting: Setting, seed: int, report: Report) -> None:
    """Compare the exits and the fates of images, for all symmetries that V has."""
    images = {name: matrix for name, matrix in IMAGES.items() if setting.system.is_symmetric(matrix, setting.size)}
    if not images:
        return
    states = setting.random_starts(STARTS, seed)
    if not len(states):
        report.add(CHECK, UNDECIDED, "no start")
        return
    for name, matrix in images.items():
        fates = exit_images(setting, matrix, setting.potential, setting.energy)
        _check_periods(setting, name, fates, report)
        compare_outcomes(setting, setting, states, image_of(states, matrix), fates, 1.0, CHECK, name, report)


def exit_images(setting: Setting, matrix: np.ndarray, potential: Potential, energy: float) -> dict[int, int]:
    """Return the fate of another potential for each fate of a setting, if a matrix maps their saddles onto each other."""
    numbers, others = ({c: o.channel for o in orbits for c in _channels(o)} for orbits in _orbits(setting, potential, energy))
    nearest = {
        k + 1: int(np.argmin(np.hypot(*(potential.saddles - matrix @ place).T))) + 1
        for k, place in enumerate(setting.potential.saddles)
    }
    return {numbers[k]: others.get(nearest[k], 0) for k in sorted(numbers, reverse=True)}


def _orbits(setting: Setting, potential: Potential, energy: float):
    return find_lyapunov_orbits(setting.potential, setting.energy), find_lyapunov_orbits(potential, energy)


def _channels(orbit) -> Sequence[int]:
    return (orbit.channel, *orbit.others)


def _check_periods(setting: Setting, name: str, fates: Mapping[int, int], report: Report) -> None:
    """Lyapunov orbits of images have equal periods."""
    periods = {orbit.channel: orbit.period for orbit in find_lyapunov_orbits(setting.potential, setting.energy)}
    for fate, image in fates.items():
        alike = image in periods and abs(periods[fate] - periods[image]) <= 1e-9 * periods[fate]
        known = {"symmetry": name, "exits": [fate, image], "periods": [periods[fate], periods.get(image)]}
        report.judge(CHECK, "exits are not images", alike, **known, **setting.reproduction)


def compare_outcomes(
    setting: Setting,
    other: Setting,
    states: np.ndarray,
    images: np.ndarray,
    fates: Mapping[int, int],
    time_factor: float,
    check: str,
    name: str,
    report: Report,
) -> None:
    """Compare the outcomes of states of a setting with those of their images in another, whose times are longer by a factor."""
    fate, time, change = setting.classify_robustly(states, DURATION * setting.time_unit)
    image_fate, image_time, image_change = other.classify_robustly(images, DURATION * setting.time_unit * time_factor)
    robust = (change <= STEADY * setting.time_unit) & (image_change <= STEADY * other.time_unit)
    robust &= (fate != Fate.FAILED) & (image_fate != Fate.FAILED)
    report.add(check, COMPARED, number=int(robust.sum()))
    report.add(check, UNDECIDED, "the fate changes with a shift of the start", int((~robust).sum()))
    for k in np.flatnonzero(robust):
        known = {
            "image": name,
            "start": states[k].tolist(),
            "said": [[int(fate[k]), time[k]], [int(image_fate[k]), image_time[k]]],
        }
        expected = fates[int(fate[k])] if fate[k] > 0 else int(fate[k])
        if image_fate[k] != expected:
            report.add_wrong(check, "a fate differs from that of the image", **known, expected=expected, **setting.reproduction)
        elif fate[k] > 0 and abs(image_time[k] - time_factor * time[k]) > (
            _LARGEST_DIFFERENCE * (setting.time_unit * time_factor + image_time[k]) + _PER_CHANGE * (image_change[k] + change[k])
        ):
            report.add_wrong(check, "an escape time differs from that of the image", **known, **setting.reproduction)
