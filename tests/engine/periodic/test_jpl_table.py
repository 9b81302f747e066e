"""Tables of periodic orbits agree with the catalogue of JPL, https://ssd.jpl.nasa.gov/tools/periodic_orbits.html."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from engine import (
    POTENTIALS,
    PeriodicOrbit,
    Potential,
    System,
    continue_family,
    find_lyapunov_orbits,
    find_periodic_orbit,
    read_jpl_table,
    write_jpl_table,
)

# The mass ratio of the catalogue, in coordinates of the Moon and of the barycentre.
NUMBERS = {"m": 0.01215058560962404}
MOON, BARYCENTRE = (System(name, "", NUMBERS).potential for name in ("Earth-Moon", "Copenhagen"))

HEADER = (
    "Id ,x0 (LU) ,y0 (LU) ,z0 (LU) ,vx0 (LU/TU) ,vy0 (LU/TU) ,vz0 (LU/TU) ,"
    "Jacobi constant (LU2/TU2) ,Period (TU) ,Period (days) ,Stability index "
)
# The distant retrograde orbit 70 000 km from the Moon. Its Jacobi constant is that of its state, to 9 digits.
DISTANT = (
    '"1","8.0591079311650515E-1","2.1618091280991729E-23","3.4136631163268282E-25","-8.1806482539864240E-13",'
    '"5.1916995982435687E-1","-5.7262098359472236E-25","2.92862124","3.2014543457713667E+0","14.25","1.0000000001631200E+0"'
)
# A halo orbit.
HALO = (
    '"2","1.0213448959167291E+0","-4.6715051049863432E-27","-1.8162633785360355E-1","-2.3333471915735886E-13",'
    '"-1.0177771593237860E-1","-3.4990116102675334E-12","3.05","1.5021912429136250E+0","6.69","1.3"'
)
# Name, Jacobi constant, period and stability index of planar Lyapunov orbits.
LYAPUNOV = [
    ("L1", 3.15273107702723, 2.8325231152377177, 964.064108375553),
    ("L1", 2.91113555914615, 6.525492852637634, 53.6707952348081),
    ("L2", 2.95787377644491, 5.640853006654308, 61.0217545317533),
]


def write(folder: Path, *lines: str) -> Path:
    file = folder / "table.csv"
    file.write_text("\n".join(lines), encoding="utf-8")
    return file


def lyapunov_orbit(name: str, constant: float) -> PeriodicOrbit:
    """Return the orbit around a Lagrange point at a Jacobi constant below 3.16."""
    (exit_orbit,) = (each for each in find_lyapunov_orbits(MOON, MOON.jacobi_energy(3.16)) if each.name == name)
    family = continue_family(exit_orbit, MOON.jacobi_energy(constant))
    return family[len(family) - 1]


@pytest.mark.parametrize("potential", [MOON, BARYCENTRE], ids=["Moon", "barycentre"])
def test_an_orbit_of_the_catalogue_closes_after_its_period(potential: Potential, tmp_path: Path) -> None:
    (start,) = read_jpl_table(potential, write(tmp_path, HEADER, DISTANT))
    orbit = find_periodic_orbit(potential, start, returns=1)
    assert orbit.period == pytest.approx(3.2014543457713667, rel=1e-11)
    np.testing.assert_allclose(orbit.start, start, atol=1e-11)


@pytest.mark.parametrize(("name", "constant", "period", "stability"), LYAPUNOV)
def test_lyapunov_orbits_have_the_numbers_of_the_catalogue(
    name: str, constant: float, period: float, stability: float, tmp_path: Path
) -> None:
    write_jpl_table(lyapunov_orbit(name, constant), tmp_path / "table.csv")
    row = pd.read_csv(tmp_path / "table.csv").iloc[0]
    assert list(row.index) == ["x", "y", "z", "vx", "vy", "vz", "jacobi", "period", "stability"]
    assert row[["jacobi", "period"]].tolist() == pytest.approx([constant, period], rel=1e-11)
    assert row["stability"] == pytest.approx(stability, rel=1e-7)
    # The constant in the coordinates of the catalogue.
    m = NUMBERS["m"]
    potential = (1.0 - m) / np.hypot(row.x + m, row.y) + m / np.hypot(row.x - 1.0 + m, row.y) + 0.5 * (row.x**2 + row.y**2)
    assert 2.0 * potential - row.vx**2 - row.vy**2 == pytest.approx(constant, abs=1e-11)
    for system in (MOON, BARYCENTRE):
        (start,) = read_jpl_table(system, tmp_path / "table.csv")
        assert find_periodic_orbit(system, start, returns=1).period == pytest.approx(period, rel=1e-11)


def test_a_family_has_a_row_for_each_member_that_is_read_exactly(tmp_path: Path) -> None:
    first = find_periodic_orbit(MOON, read_jpl_table(MOON, write(tmp_path, HEADER, DISTANT))[0], returns=1)
    family = continue_family(first, (first.energy - 1e-3, first.energy + 1e-3))
    write_jpl_table(family, tmp_path / "family.csv")
    starts = read_jpl_table(MOON, tmp_path / "family.csv")
    np.testing.assert_allclose(starts, family.states[:, 0], rtol=0.0, atol=1e-15)
    assert pd.read_csv(tmp_path / "family.csv")["stability"].tolist() == [1.0] * len(family)


def test_lyapunov_orbits_of_exits_are_read_as_they_were_written(tmp_path: Path) -> None:
    orbits = find_lyapunov_orbits(MOON, MOON.jacobi_energy(3.16))
    write_jpl_table(orbits, tmp_path / "exits.csv")
    starts = read_jpl_table(MOON, tmp_path / "exits.csv")
    np.testing.assert_allclose(starts, [orbit.start for orbit in orbits], rtol=0.0, atol=1e-15)
    table = pd.read_csv(tmp_path / "exits.csv")
    assert table["stability"].tolist() == pytest.approx([orbit.stability_index for orbit in orbits])


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        ((HEADER, DISTANT, HALO), "row 2: z and vz must be 0"),
        ((HEADER, DISTANT.replace("2.92862124", "2.93")), "row 1: jacobi must be the constant of its state in Earth-Moon"),
        ((HEADER, DISTANT.replace("8.0591079311650515E-1", "x")), "row 1: must have finite numbers"),
        ((HEADER.replace("vy0", "speed"), DISTANT), "has no columns vy; must have x, y, z, vx, vy, vz, jacobi"),
    ],
    ids=["out of the plane", "constant", "number", "column"],
)
def test_a_table_that_cannot_be_used_is_refused(lines: tuple[str, ...], sentence: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=sentence):
        read_jpl_table(MOON, write(tmp_path, *lines))


def test_a_table_of_another_system_is_refused(tmp_path: Path) -> None:
    table = write(tmp_path, HEADER, DISTANT)
    with pytest.raises(ValueError, match="is it a table of another system"):
        read_jpl_table(POTENTIALS["Copenhagen"], table)
    with pytest.raises(ValueError, match="its frame must rotate"):
        read_jpl_table(POTENTIALS["I"], table)


def test_only_periodic_orbits_of_rotating_systems_are_written(tmp_path: Path) -> None:
    orbit = find_periodic_orbit(POTENTIALS["III"], [0.0, 0.0, 0.05, 0.77], returns=1)
    with pytest.raises(ValueError, match="its frame must rotate"):
        write_jpl_table(orbit, tmp_path / "table.csv")
    with pytest.raises(ValueError, match="orbits=1: must be"):
        write_jpl_table([1], tmp_path / "table.csv")  # type: ignore[list-item]
