"""Percentages stated by Zotos (2014), Nonlinear Dynamics, doi 10.1007/s11071-014-1524-9, that do not depend on a window."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, EscapeMap, Fate, MapSpec, Plane, compute_map

PERCENT = 0.01


def interior_map(name: str, plane: Plane, energy: float, t_max: float = 1e4, side: int = 150) -> EscapeMap:
    return compute_map(MapSpec(CASES[name], plane, energy, (side, side), t_max=t_max))


def shares(result: EscapeMap, *, count_outside: bool = False) -> list[float]:
    fractions = result.fractions(count_outside=count_outside)
    return [fractions[k] for k in range(1, result.spec.potential.channels + 1)]


def direct_share(result: EscapeMap) -> float:
    interior = (result.fate != Fate.FORBIDDEN) & (result.fate != Fate.OUTSIDE)
    return float(np.mean((result.fate[interior] >= 1) & (result.crossings[interior] == 0)))


def test_case_1_on_x_px_at_05_is_60_to_40() -> None:
    assert shares(interior_map("I", Plane.X_PX, 0.5)) == pytest.approx([0.60, 0.40], abs=PERCENT)


def share_outside(x_high: float, side: int = 150) -> float:
    # Outside starts of case II lie to the right of the interior, so the right edge of the window determines their share.
    result = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.5, (side, side), (-1.0, x_high, -2.0, 2.0), t_max=1e-9))
    outside = np.sum(result.fate == Fate.OUTSIDE)
    return float(outside / np.sum(result.fate != Fate.FORBIDDEN))


def test_case_2_on_x_px_at_05_is_70_20_10_with_outside_starts() -> None:
    low, high = 1.2, 3.0
    for _ in range(20):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if share_outside(middle) < 0.556 else (low, middle)
    result = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.5, (150, 150), (-1.0, high, -2.0, 2.0), t_max=1e3))
    assert shares(result, count_outside=True) == pytest.approx([0.70, 0.20, 0.10], abs=PERCENT)


def test_case_3_on_x_y_at_06_has_no_bounded_orbits() -> None:
    # Orbits that stay on x = 0 by symmetry do not count, because default maps have no pixel on this line.
    assert compute_map(MapSpec(CASES["III"], Plane.X_Y, 0.6)).fractions()[Fate.BOUNDED] == 0.0


# The paper's fits give 0.90, 0.85 and 0.92 here.
@pytest.mark.parametrize(
    ("name", "energy", "expected", "fit"), [("I", 0.5, 0.885, 0.90), ("II", 0.5, 0.851, 0.85), ("III", 0.6, 0.930, 0.92)]
)
def test_share_of_direct_escapes_at_high_energy(name: str, energy: float, expected: float, fit: float) -> None:
    direct = direct_share(interior_map(name, Plane.X_PX, energy))
    assert direct == pytest.approx(expected, abs=0.005)
    assert direct == pytest.approx(fit, abs=2 * PERCENT)


# Ne/N0 = ½[1 + tanh(a h − b)], at energies where the fit is neither close to 0 nor steep.
@pytest.mark.parametrize(
    ("name", "energy", "a", "b"),
    [("I", 0.19, 30, 4), ("II", 0.20, 49, 6.5), ("III", 0.45, 15.85, 4.93)],
)
def test_escape_share_follows_the_fit_of_the_paper(name: str, energy: float, a: float, b: float) -> None:
    escaped = sum(shares(interior_map(name, Plane.X_PX, energy, side=70)))
    assert escaped == pytest.approx(0.5 * (1 + np.tanh(a * energy - b)), abs=0.06)
