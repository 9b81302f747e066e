"""Define the first view of a live figure, and what its reader can choose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from engine import CASES, POTENTIALS, MapSpec, Potential, System
from engine.foundations.validation import check_type, checked_choice, checked_number, short_repr
from engine.systems.catalogue.entry import EnergyRange
from engine.systems.review.potential_review import review_potential, review_system
from plots.pictures.palette import DEFAULT_COLOURS, Palette

LIVE_PICTURES = ("basins", "times", "crossings")
"""Names of the pictures of a live figure."""


@dataclass(frozen=True)
class LiveView:
    """The request for a live figure.

    Parameters
    ----------
    spec
        The map that is shown first, for which there is no `live_refusal`.
    energies
        Lowest and highest energy that a reader can choose, dimensionless, with the energy of the map between them; None for the
        energies at which the page explores the system.
    starts
        (x, ordinate) of chosen orbits, at most five.
    picture
        The picture that is shown first: basins, times or crossings.
    caption
        A text below the figure.
    link
        Address of the view in an explorer, which begins with http:// or https://; empty for none.
    palette
        Colours of the map.
    title
        Heading of the figure; empty for system and slice.

    Raises
    ------
    ValueError
        If there is no live figure of the map, there are too many starts, or a value is not legal.
    """

    spec: MapSpec
    energies: tuple[float, float] | None = None
    starts: Sequence[tuple[float, float]] = ()
    picture: str = LIVE_PICTURES[0]
    caption: str = ""
    link: str = ""
    palette: Palette = DEFAULT_COLOURS
    title: str = ""

    def __post_init__(self) -> None:
        if refusal := live_refusal(self.spec):
            raise ValueError(f"plane: {refusal}")
        for name in ("caption", "link", "title"):
            check_type(name, getattr(self, name), str)
        if self.energies is not None:
            _check_energies(self.energies, self.spec.common_energy)
        check_type("starts", self.starts, Sequence)
        if len(self.starts) > len(self.palette.orbits):
            raise ValueError(f"starts: there are {len(self.starts)}; must be at most {len(self.palette.orbits)}")
        for start in self.starts:
            _checked_pair("starts", start)
        checked_choice("picture", self.picture, LIVE_PICTURES)
        if self.link and not self.link.startswith(("http://", "https://")):
            raise ValueError(f"link={self.link!r}: must begin with http:// or https://")

    @property
    def pictures(self) -> list[str]:
        """All pictures of the figure, that which is shown first at the beginning."""
        return sorted(LIVE_PICTURES, key=lambda name: name != self.picture)

    @property
    def heading(self) -> str:
        """The title, or else system and slice."""
        return self.title or view_title(self.spec)

    @cached_property
    def map_energies(self) -> tuple[float, float]:
        """The lowest and the highest energy of the map, which differ on a slice with an axis h."""
        if self.spec.common_energy is not None:
            return self.spec.common_energy, self.spec.common_energy
        x_low, x_high, ordinate_low, ordinate_high = self.spec.find_window().edges
        return (x_low, x_high) if self.spec.plane.energy_axis == 0 else (ordinate_low, ordinate_high)

    def find_energies(self) -> tuple[float, float]:
        """Return the lowest and the highest energy of the figure."""
        if self.energies is not None:
            return self.energies
        suggested, (low, high) = _suggested_energies(self.spec.potential), self.map_energies
        return min(suggested.low, low), max(suggested.high, high)


def live_refusal(spec: MapSpec) -> str:
    """Return why there is no live figure of a map; empty if there is one."""
    parameter = spec.plane.parameter
    if parameter is None:
        return ""
    return f"along {parameter.symbol} each orbit belongs to another system, and a live figure has the exits of one system"


def view_title(spec: MapSpec) -> str:
    """Return system and slice of a map."""
    name = spec.potential.name
    return f"{'Case ' if name in CASES else ''}{name}, {spec.plane.title}{', backward in time' if spec.backward else ''}"


def _suggested_energies(potential: Potential) -> EnergyRange:
    """Return the energies of the catalogue for its potentials, and for others those that their review suggests."""
    name = potential.name
    is_known = name in POTENTIALS and POTENTIALS[name] == potential
    return review_system(System(name)).energies if is_known else review_potential(potential).energies


def _checked_pair(name: str, value: Any) -> tuple[float, float]:
    try:
        first, second = value
    except (TypeError, ValueError):
        raise ValueError(f"{name}={short_repr(value)}: must be a pair of numbers") from None
    return checked_number(name, first), checked_number(name, second)


def _check_energies(energies: tuple[float, float], energy: float | None) -> None:
    low, high = _checked_pair("energies", energies)
    if not low < high or (energy is not None and not low <= energy <= high):
        raise ValueError(f"energies={energies}: must rise, with the energy of the map between them")
