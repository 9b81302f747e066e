"""The numbers on escapes that Zotos (2014) states, Nonlinear Dynamics, doi 10.1007/s11071-014-1524-9."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from engine import Plane
from reproduction.paper_ranges import nine_energies


class Quantity(Enum):
    """A measured quantity. The value is its name in the report."""

    ESCAPED_BY = "escape through"
    BOUNDED = "bounded"
    ESCAPED = "escape"
    DIRECT = "escape directly"
    CHAOTIC = "chaotic share of the bounded"
    LAST_BOUNDED_ENERGY = "highest h with a bounded start"
    MEDIAN_ESCAPE_TIME = "median escape time"
    ENERGY_ERROR = "largest relative energy error"
    ACCURATE = "relative energy error below 1e-11"
    ESCAPE_ENERGY = "escape energy"
    LYAPUNOV_R2 = "R² of the Lyapunov orbits"
    LAST_ESCAPE = "escape time of the last chaotic bounded orbit"
    NEAREST_ESCAPE = "nearest escape time through"
    LARGEST_SHARE_ENERGY = "h of the largest share of channel"
    IN_BASINS = "starts inside basins"
    WADA = "boundary starts next to all basins"
    EXPONENT = "fat-fractal exponent (computed: uncertainty exponent)"
    TIME_ORDERS = "orders of magnitude from escape times near exits to those near islands"


class Relation(Enum):
    """The relation of a quantity to the stated value. The value is the word in the paper."""

    EXACTLY = ""
    ABOUT = "about"
    MORE_THAN = "more than"
    LESS_THAN = "less than"
    RISES_TO = "rises to"


class Counting(Enum):
    """The set of starts to which a share is relative."""

    ANY = "of any starts"
    """The share does not depend on the counting: no starts are outside on this plane, or the share is 0."""
    INTERIOR = "of the starts inside"
    """The share is relative to the starts inside, whose orbits are integrated."""
    WINDOW = "of a window that is not stated"
    """There are starts outside on this plane, and the paper seems to count them."""


@dataclass(frozen=True)
class StatedNumber:
    """One number stated in the paper.

    Attributes
    ----------
    case
        Key of `engine.CASES`.
    plane
        Plane of the starts; None if the number does not depend on a plane.
    energies
        Energies of the computed values, several for a stated range. On (x, h), the lowest and highest h of the plane.
    at
        Energy or range, as stated.
    quantity
        Measured quantity.
    relation, value
        Stated value: in percent for shares, else dimensionless.
    channels
        Channels that are counted together; empty if the quantity does not depend on channels.
    counting
        Starts to which a share is relative.
    remark
        Reason for any difference, with fields named in `reproduction.numbers.reasons.FACTS` for computed values.
    derivation
        How the value follows from the text; empty if the text states it.
    """

    case: str
    plane: Plane | None
    energies: tuple[float, ...]
    at: str
    quantity: Quantity
    relation: Relation
    value: float
    channels: tuple[int, ...] = ()
    counting: Counting = Counting.ANY
    remark: str = ""
    derivation: str = ""

    @property
    def is_share(self) -> bool:
        """Whether the number is a percentage."""
        return self.quantity in _SHARES

    @property
    def needs_window(self) -> bool:
        """Whether the number depends on a window that the paper does not state."""
        return self.counting is Counting.WINDOW


_SHARES = (
    Quantity.ESCAPED_BY, Quantity.BOUNDED, Quantity.ESCAPED, Quantity.DIRECT, Quantity.CHAOTIC, Quantity.ACCURATE,
    Quantity.IN_BASINS, Quantity.WADA,
)  # fmt: skip

# Short names for the tables below.
_ABOUT, _MORE, _LESS, _EXACTLY = Relation.ABOUT, Relation.MORE_THAN, Relation.LESS_THAN, Relation.EXACTLY
_THROUGH, _BOUNDED, _ESCAPED, _DIRECT = Quantity.ESCAPED_BY, Quantity.BOUNDED, Quantity.ESCAPED, Quantity.DIRECT
_ACCURATE, _IN_BASINS, _CHAOTIC = Quantity.ACCURATE, Quantity.IN_BASINS, Quantity.CHAOTIC
_INTERIOR, _WINDOW = Counting.INTERIOR, Counting.WINDOW
_X_Y, _X_PX, _X_H = Plane.X_Y, Plane.X_PX, Plane.X_H

# Remarks, whose fields in braces are names of `reproduction.numbers.reasons.FACTS`.
_MEDIAN = "Only {late_share:.1f} % of the escapes are so late."
_HALF = "{bounded_at_5000:.1f} % of the starts are bounded at t = 5000, {bounded_at_20000:.1f} % at t = 20 000."
_REGULAR = (
    "Bounded orbits whose SALI falls below its threshold: {chaotic_orbits}, of which leave later: {chaotic_escapes}; see "
    "[chaotic bounded orbits](#chaotic-bounded-orbits)."
)
_TINY = "Above the stated h {bounded_above} starts are bounded: tiny islands, which a coarser grid misses."
_OVER_100 = "The four stated shares sum to 102."
_OVER_106 = "The five stated shares sum to 106."
_OWN_FIT = "The paper's own fit gives {paper_direct:.1f} % at h = 0.5; its text states less than its curve."
_FALLING = "The shares still decrease there, to {share_at_last:.1f} % at the highest h."
_LAST_ISLANDS = "Islands exist up to h = {last_bounded:.3f} on (x, h); the paper states both 0.55 and 0.6 as their end."
_NINE_TENTHS = "The computed {share_at_last:.0f} % may be stated as about 90."
_ACCIDENT = "Such late escapes depend on rounding; of {chaotic_orbits} chaotic orbits {chaotic_escapes} escape, in the paper all."
_LYAPUNOV = "On the Lyapunov orbits R² is just above 1, its value at the saddles; 1.26 is well outside of them."
_GRID = "Depends on the grid and on the definition: finer grids have fewer starts near boundaries."
_FLAT = "At the stated h the share is lower by {below_largest:.1f} points only."
_STILL_FRACTAL = "The boundaries are still fractal at the highest h of the paper."
_NEAR = "Depends on the grid and on the definition: times next to an island rise with the resolution."

# Derivations.
_SHARED = "three equal shares"
_HALVED = "half of the rest"
_REST = "the rest to 100"
_ALL_REGULAR = "all are called regular"
_MOST = "most"
_OUTNUMBERED = "more escape than are bounded"
_TENS = "tens of thousands for most"
_WADA = "definition of Wada basins"

# Energies around the stated turning point.
_TURN_H = tuple(round(0.15 + 0.0025 * step, 4) for step in range(17))
# Energies from the first map to the end of the paper's curves.
_EXPONENT_H = (*nine_energies("I")[::2], 0.4, 0.5)
# All energies of the maps except the last, at which no orbit is bounded.
_ISLAND_H = nine_energies("III")[:-1]

_CASE_I = (
    StatedNumber("I", None, (), "", Quantity.ESCAPE_ENERGY, _EXACTLY, 1 / 8),
    StatedNumber("I", _X_PX, (), "all", Quantity.ENERGY_ERROR, _LESS, 1e-10),
    StatedNumber("I", _X_PX, nine_energies("I"), "all", _ACCURATE, _MORE, 50.0, derivation=_MOST),
    StatedNumber("I", _X_Y, (0.13,), "0.13", _BOUNDED, _ABOUT, 100 / 3, (), _WINDOW, derivation=_SHARED),
    StatedNumber("I", _X_Y, (0.13,), "0.13", _THROUGH, _ABOUT, 100 / 3, (1,), _WINDOW, derivation=_SHARED),
    StatedNumber("I", _X_Y, (0.13,), "0.13", _THROUGH, _ABOUT, 100 / 3, (2,), _WINDOW, derivation=_SHARED),
    StatedNumber("I", _X_Y, (0.13,), "0.13", Quantity.MEDIAN_ESCAPE_TIME, _MORE, 1e4, (), _INTERIOR, _MEDIAN, _TENS),
    StatedNumber("I", _X_Y, (0.285, 0.3, 0.4), "> 0.28", _BOUNDED, _ABOUT, 0.0),
    StatedNumber("I", _X_Y, (0.38, 0.44, 0.5), "> 0.35", _THROUGH, _ABOUT, 65.0, (1,), _WINDOW),
    StatedNumber("I", _X_Y, (0.38, 0.44, 0.5), "> 0.37", _THROUGH, _ABOUT, 35.0, (2,), _WINDOW),
    StatedNumber("I", _X_Y, _TURN_H, "0.15 to 0.19", Quantity.LARGEST_SHARE_ENERGY, _ABOUT, 0.17, (2,), _INTERIOR, _FLAT),
    StatedNumber("I", _X_Y, (0.5,), "high", _IN_BASINS, _ABOUT, 90.0, (), _WINDOW, _GRID),
    StatedNumber("I", _X_Y, _EXPONENT_H, "high", Quantity.EXPONENT, Relation.RISES_TO, 1.0, (), _INTERIOR, _STILL_FRACTAL),
    StatedNumber("I", _X_PX, (0.13,), "0.13", _BOUNDED, _ABOUT, 50.0, remark=_HALF),
    StatedNumber("I", _X_PX, (0.13,), "0.13", _THROUGH, _ABOUT, 25.0, (1,), remark=_HALF, derivation=_HALVED),
    StatedNumber("I", _X_PX, (0.13,), "0.13", _THROUGH, _ABOUT, 25.0, (2,), remark=_HALF, derivation=_HALVED),
    StatedNumber("I", _X_PX, nine_energies("I"), "any", _CHAOTIC, _ABOUT, 0.0, remark=_REGULAR, derivation=_ALL_REGULAR),
    StatedNumber("I", _X_PX, (0.305, 0.4, 0.5), "> 0.3", _BOUNDED, _ABOUT, 0.0),
    StatedNumber("I", _X_PX, (0.5,), "0.5", _THROUGH, _ABOUT, 60.0, (1,)),
    StatedNumber("I", _X_PX, (0.5,), "0.5", _THROUGH, _ABOUT, 40.0, (2,)),
    StatedNumber("I", _X_PX, (0.5,), "high", _DIRECT, _ABOUT, 90.0),
    StatedNumber("I", _X_PX, (0.5,), "high", _IN_BASINS, _ABOUT, 90.0, remark=_GRID),
    StatedNumber("I", _X_PX, (0.52, 0.55, 0.6), "> 0.5", _DIRECT, _MORE, 90.0),
)

_CASE_II = (
    StatedNumber("II", None, (), "", Quantity.ESCAPE_ENERGY, _EXACTLY, 1 / 6),
    StatedNumber("II", _X_PX, (), "all", Quantity.ENERGY_ERROR, _LESS, 1e-10),
    StatedNumber("II", _X_PX, nine_energies("II"), "all", _ACCURATE, _MORE, 50.0, (), _INTERIOR, derivation=_MOST),
    StatedNumber("II", _X_Y, (0.17,), "0.17", _BOUNDED, _ABOUT, 4.0, (), _WINDOW, _OVER_100),
    StatedNumber("II", _X_Y, (0.17,), "0.17", _THROUGH, _ABOUT, 34.0, (1,), _WINDOW, _OVER_100),
    StatedNumber("II", _X_Y, (0.17,), "0.17", _THROUGH, _ABOUT, 32.0, (2,), _WINDOW, _OVER_100),
    StatedNumber("II", _X_Y, (0.17,), "0.17", _THROUGH, _ABOUT, 32.0, (3,), _WINDOW, _OVER_100),
    StatedNumber("II", _X_Y, (0.205, 0.22, 0.3), "> 0.2", _BOUNDED, _ABOUT, 0.0),
    StatedNumber("II", _X_Y, (0.42, 0.46, 0.5), "> 0.4", _THROUGH, _ABOUT, 32.0, (1,), _WINDOW),
    StatedNumber("II", _X_Y, (0.42, 0.46, 0.5), "> 0.4", _THROUGH, _ABOUT, 44.0, (2,), _WINDOW),
    StatedNumber("II", _X_Y, (0.42, 0.46, 0.5), "> 0.4", _THROUGH, _ABOUT, 24.0, (3,), _WINDOW, derivation=_REST),
    StatedNumber("II", _X_Y, (0.5,), "high", _IN_BASINS, _ABOUT, 90.0, (), _WINDOW, _GRID),
    StatedNumber("II", _X_PX, (0.17,), "0.17", _THROUGH, _ABOUT, 55.0, (1,), _WINDOW),
    StatedNumber("II", _X_PX, (0.17,), "0.17", _THROUGH, _ABOUT, 44.0, (2, 3), _WINDOW),
    StatedNumber("II", _X_PX, (0.17, 0.18, 0.2, 0.3, 0.5), "> 1/6", _ESCAPED, _MORE, 95.0, (), _INTERIOR),
    StatedNumber("II", _X_PX, nine_energies("II"), "any", _CHAOTIC, _ABOUT, 0.0, (), _INTERIOR, _REGULAR, _ALL_REGULAR),
    StatedNumber("II", _X_PX, (0.205, 0.22, 0.3), "> 0.2", _BOUNDED, _ABOUT, 0.0),
    StatedNumber("II", _X_PX, (0.255, 0.3, 0.4), "> 0.25", _BOUNDED, _ABOUT, 0.0),
    StatedNumber("II", _X_PX, (0.5,), "0.5", _THROUGH, _ABOUT, 70.0, (1,), _WINDOW),
    StatedNumber("II", _X_PX, (0.5,), "0.5", _THROUGH, _ABOUT, 20.0, (2,), _WINDOW),
    StatedNumber("II", _X_PX, (0.5,), "0.5", _THROUGH, _ABOUT, 10.0, (3,), _WINDOW),
    StatedNumber("II", _X_PX, (0.5,), "high", _IN_BASINS, _ABOUT, 90.0, (), _WINDOW, _GRID),
    StatedNumber("II", _X_PX, nine_energies("II"), "all", Quantity.WADA, _ABOUT, 100.0, (), _INTERIOR, "", _WADA),
    StatedNumber("II", _X_PX, (0.45, 0.5), "high", _DIRECT, _MORE, 70.0, (), _INTERIOR),
    StatedNumber("II", _X_PX, (0.5, 0.52, 0.55), "> 0.5", _DIRECT, _ABOUT, 80.0, (), _INTERIOR, _OWN_FIT),
    StatedNumber("II", _X_H, (1 / 6, 0.5), "(1/6, 1/2]", Quantity.LAST_BOUNDED_ENERGY, _LESS, 0.22, (), _INTERIOR, _TINY),
)

_CASE_III = (
    StatedNumber("III", None, (), "", Quantity.ESCAPE_ENERGY, _EXACTLY, 1 / 4),
    StatedNumber("III", _X_PX, (), "all", Quantity.ENERGY_ERROR, _LESS, 1e-10),
    StatedNumber("III", _X_PX, nine_energies("III"), "all", _ACCURATE, _MORE, 50.0, derivation=_MOST),
    StatedNumber("III", _X_Y, (0.26,), "0.26", _BOUNDED, _ABOUT, 50.0, (), _WINDOW, _OVER_106),
    StatedNumber("III", _X_Y, (0.26,), "0.26", _THROUGH, _ABOUT, 14.0, (1,), _WINDOW, _OVER_106),
    StatedNumber("III", _X_Y, (0.26,), "0.26", _THROUGH, _ABOUT, 14.0, (2,), _WINDOW, _OVER_106),
    StatedNumber("III", _X_Y, (0.26,), "0.26", _THROUGH, _ABOUT, 14.0, (3,), _WINDOW, _OVER_106),
    StatedNumber("III", _X_Y, (0.26,), "0.26", _THROUGH, _ABOUT, 14.0, (4,), _WINDOW, _OVER_106),
    StatedNumber("III", _X_Y, (0.6,), "0.6", _BOUNDED, _ABOUT, 0.0),
    StatedNumber("III", _X_Y, (0.6,), "0.6", _THROUGH, _ABOUT, 65.0, (1, 2), _WINDOW),
    StatedNumber("III", _X_Y, (0.6,), "0.6", _THROUGH, _ABOUT, 35.0, (3, 4), _WINDOW),
    StatedNumber("III", _X_Y, (0.6,), "high", _IN_BASINS, _ABOUT, 90.0, (), _WINDOW, _GRID),
    StatedNumber("III", _X_Y, _ISLAND_H, "0.26 to 0.55", Quantity.TIME_ORDERS, _ABOUT, 2.0, (), _INTERIOR, _NEAR),
    StatedNumber("III", _X_PX, (0.26,), "0.26", _BOUNDED, _ABOUT, 90.0),
    StatedNumber("III", _X_PX, (0.26, 0.27, 0.28, 0.29), "< 0.3", _BOUNDED, _MORE, 50.0, derivation=_MOST),
    StatedNumber("III", _X_PX, (0.36, 0.4, 0.5), "> 0.35", _ESCAPED, _MORE, 50.0, derivation=_OUTNUMBERED),
    StatedNumber("III", _X_PX, (0.46, 0.5, 0.6), "> 0.45", _ESCAPED, _MORE, 90.0),
    StatedNumber("III", _X_PX, (0.42, 0.5, 0.6), "> 0.4", _THROUGH, _ABOUT, 5.0, (3,), remark=_FALLING),
    StatedNumber("III", _X_PX, (0.42, 0.5, 0.6), "> 0.4", _THROUGH, _ABOUT, 5.0, (4,), remark=_FALLING),
    StatedNumber("III", _X_PX, (0.56, 0.6), "> 0.55", _BOUNDED, _ABOUT, 0.0, remark=_LAST_ISLANDS),
    StatedNumber("III", _X_PX, (0.6,), "0.6", _THROUGH, _ABOUT, 90.0, (1, 2), remark=_NINE_TENTHS),
    StatedNumber("III", _X_PX, (0.6,), "high", _IN_BASINS, _ABOUT, 90.0, remark=_GRID),
    StatedNumber("III", _X_PX, (0.62, 0.65, 0.7), "> 0.6", _DIRECT, _MORE, 90.0),
    StatedNumber("III", _X_H, (0.25, 1.0), "(0.25, 1]", Quantity.LAST_BOUNDED_ENERGY, _ABOUT, 0.6),
    StatedNumber("III", _X_PX, (0.26,), "0.26", _CHAOTIC, _LESS, 10.0),
    StatedNumber("III", _X_PX, (0.26,), "0.26", Quantity.LAST_ESCAPE, _ABOUT, 3.5e6, remark=_ACCIDENT),
    StatedNumber("III", _X_PX, (0.26,), "0.26", Quantity.NEAREST_ESCAPE, _ABOUT, 851e3, (2,), remark=_ACCIDENT),
    StatedNumber("III", _X_Y, (0.26,), "0.26", Quantity.LYAPUNOV_R2, _ABOUT, 1.26, remark=_LYAPUNOV),
)

STATED_NUMBERS: tuple[StatedNumber, ...] = (*_CASE_I, *_CASE_II, *_CASE_III)
"""All numbers of the text, by case.

The fits of Ne/N0 and Nde/N0 are `PAPER_FITS`. The text states no numbers for dN_n and p_n.
"""
