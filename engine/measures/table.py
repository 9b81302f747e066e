"""The measures of maps as entries of one table, which the page, files, figures and the command line use."""

from __future__ import annotations

import math
from collections.abc import Mapping
from operator import attrgetter, methodcaller
from typing import Any

import numpy as np

from engine.foundations.plug_ins import Entries, Group
from engine.foundations.wording import describe_codes
from engine.maps.result import EscapeMap
from engine.measures.basins.basin_entropy import compute_basin_entropy
from engine.measures.basins.chaotic_share import ChaoticShare, compute_chaotic_share
from engine.measures.basins.decay_law_fits import fit_decay_laws
from engine.measures.basins.decay_laws import DecayLaws
from engine.measures.basins.escape_statistics import EscapeStatistics
from engine.measures.basins.islands import MIN_ISLAND_PIXELS, compute_islands
from engine.measures.basins.power_law_fit import UncertaintyExponent
from engine.measures.basins.wada import compute_wada_test
from engine.measures.flux import EscapeFlux, compute_flux
from engine.measures.measure import HIGH_TEMPLATE, LOW_TEMPLATE, NO_CURVE, Bars, Curve, Measure, Quantity, Variables
from engine.measures.measured_map import MeasuredMap, SweepPoint
from engine.measures.uncertain_pairs import WORK, compute_uncertainty_exponent
from engine.propagation.fates import Fate, renumber
from engine.slices.axes import highest_energy

_describe = methodcaller("describe")


def _share_variables(point: SweepPoint, statistics: EscapeStatistics) -> Variables:
    """Return the shares of bounded orbits and of each outcome among the interior starts, with 95 % intervals (Wilson 1927).

    The intervals hold for independent random starts.
    """
    shares, low, high = np.zeros((3, len(point.outcomes) + 1))
    for fate, number in enumerate(point.numbers):
        shares[number] = statistics.shares[fate]
        low[number], high[number] = statistics.share_intervals[fate]
    described = {
        "share": (shares, "share of the interior starts"),
        "share_low": (low, LOW_TEMPLATE.format("share")),
        "share_high": (high, HIGH_TEMPLATE.format("share")),
    }
    return {
        "outcome": ("outcome", np.arange(shares.size), _fate_attributes(point)),
        **{name: ("outcome", values, {"long_name": text, "units": "1"}) for name, (values, text) in described.items()},
    }


def _map_variables(point: SweepPoint, escape_map: EscapeMap) -> Variables:
    """Return all arrays of the map, as in `EscapeMap.to_xarray`; fates have the numbers of the sweep."""
    dataset = escape_map.to_xarray()
    sweep_fate = renumber(escape_map.fate, np.array(point.numbers, escape_map.fate.dtype))
    attributes = {**dataset["fate"].attrs, **_fate_attributes(point)}
    variables = {str(name): variable for name, variable in dataset.variables.items()}
    return variables | {"fate": (dataset["fate"].dims, sweep_fate, attributes)}


def _fate_attributes(point: SweepPoint) -> dict[str, str]:
    """Return the attributes that explain the numbers of fates in the sweep."""
    return describe_codes(Fate, [outcome.label for outcome in point.outcomes])


def _read_decay_rate(laws: DecayLaws) -> tuple[float, float, float]:
    """Return the rate of the exponential law and its interval; NaN if the law is ruled out or the escapes are too few."""
    fit = laws.exponential
    return (fit.rate, fit.low, fit.high) if fit is not None and fit.plausible else (math.nan,) * 3


def _find_exponent(measured: MeasuredMap) -> UncertaintyExponent | None:
    """Return the exponent; None if no exit over a saddle is open."""
    spec = measured.spec
    if not spec.potential.well.open_channels(highest_energy(spec.energy)):
        return None
    return compute_uncertainty_exponent(spec, work=measured.effort * WORK, rng=0, execution=measured.execution)


def _find_chaotic_share(measured: MeasuredMap) -> ChaoticShare | None:
    """Return the share; None with gaps such as the discs of bodies, near which SALI does not show chaos."""
    return None if measured.spec.potential.gaps else compute_chaotic_share(measured.find_characters())


def _find_flux(measured: MeasuredMap) -> EscapeFlux | None:
    """Return the flux; None on a slice of several energies or potentials, without exits over saddles, and in a rotating frame."""
    spec = measured.spec
    if spec.common_energy is None or spec.plane.parameter is not None:
        return None
    has_flux = spec.potential.channels and not spec.potential.rotation and spec.common_energy > spec.potential.well.bottom
    return compute_flux(spec.potential, spec.common_energy) if has_flux else None


_ENTRIES = (
    Measure(
        "shares", "Shares of the interior starts", "how many starts end where",
        lambda measured: measured.statistics,
        (
            Quantity("direct_share", "share that escapes without a crossing of the section", attrgetter("direct_share")),
        ),
        curve=Curve("percentage of starts"),
        other_variables=_share_variables,
        help="The shares of the interior starts that escape through each exit, and of the starts that stay, against the energy "
        "or a parameter. Just above the escape energy nearly all stay. The islands of bounded orbits shrink and vanish one "
        "after the other as the energy rises.",
    ),
    Measure(
        "escape_times", "Escape time", "how long orbits stay",
        lambda measured: measured.statistics,
        (
            Quantity("mean_escape_time", "mean escape time", attrgetter("mean_escape_time"), label="mean"),
            Quantity("median_escape_time", "median escape time", attrgetter("median_escape_time"), label="median"),
        ),
        curve=Curve("escape time", logarithmic=True),
        help="Mean and median of the escape time of the orbits that escape. A mean far above the median comes from a few "
        "sticky orbits, and then it depends on t_max.",
    ),
    Measure(
        "islands", "Area of the bounded starts", "how much never escapes",
        lambda measured: compute_islands(measured.starts),
        (
            Quantity(
                "bounded_area", "area of the bounded starts", attrgetter("area", "area_error"), Bars.GRID_ERROR, "all islands"
            ),
            Quantity(
                "islands", f"connected parts of the bounded starts with at least {MIN_ISLAND_PIXELS} pixels", attrgetter("count")
            ),
            Quantity(
                "largest_island", "area of the largest of these parts", attrgetter("largest", "largest_error"),
                Bars.GRID_ERROR, "the largest",
            ),
        ),
        curve=Curve("area"),
        sentence=_describe,
        help="The area that bounded starts cover on the slice, and that of the largest island: of pixels that touch each "
        "other, four or more of them. At a resonance an island splits or loses its edge, and the area falls at once. Bars are "
        "the error of counting pixels along a smooth edge.",
    ),
    Measure(
        "basin_entropy", "Basin entropy", "how mixed the basins are",
        lambda measured: compute_basin_entropy(measured.starts),
        (
            Quantity("s_b", "basin entropy", attrgetter("s_b", "s_b_error"), Bars.STANDARD_ERROR, "S_b"),
            Quantity("s_bb", "boundary basin entropy", attrgetter("s_bb", "s_bb_error"), Bars.STANDARD_ERROR, "S_bb"),
        ),
        curve=Curve("entropy", least_top=0.72, level=(math.log(2.0), "ln 2")),
        sentence=_describe,
        help="How mixed the basins are in boxes of 5 by 5 pixels: S_b over all boxes, S_bb over the boxes with more than one "
        "fate. A smooth boundary between two basins gives S_bb at most ln 2, the dashed line; above it, boundaries are fractal "
        "at the scale of a box. Below it there is no conclusion.",
        terms={
            "Basin entropy": "How mixed the fates of the starts are in small boxes, by Gibbs's formula; zero where all fates are "
            "the same.",
            "S_b": "The basin entropy, averaged over all boxes.",
            "S_bb": "The basin entropy, averaged over the boxes with more than one fate; above ln 2 the boundaries are not "
            "smooth.",
        },
    ),
    Measure(
        "wada", "Wada distance", "whether basins share one boundary",
        lambda measured: compute_wada_test(measured.starts),
        (
            Quantity(
                "wada_distance", "pixels within which 99 % of the boundaries coincide", attrgetter("radius_99"),
                label="pixels for 99 % of the boundary",
            ),
        ),
        curve=Curve("pixels", least_top=10.0),
        sentence=_describe,
        help="The distance in pixels within which 99 % of the boundary pixels are close to all basins at once. A few pixels at "
        "any resolution are a sign of Wada basins, in which each boundary point touches all basins. With two basins "
        "there is nothing to measure.",
        terms={
            "Wada": "Basins have the Wada property if each point on the boundary of one of them is on the boundary of all "
            "others."
        },
    ),
    Measure(
        "decay_rate", "Decay law", "how the number inside falls",
        lambda measured: fit_decay_laws(measured.statistics, measured.spec.t_max),
        (
            Quantity("decay_rate", "rate of the exponential law of late escapes", _read_decay_rate, Bars.INTERVAL, "κ"),
        ),
        curve=Curve("κ"),
        sentence=_describe,
        help="The rate κ of the exponential law S(t) ∝ exp(−κ t) that the late escapes follow, with its 95 % interval. There is "
        "no point where an exponential law is ruled out, mostly because orbits stick to islands, or where few orbits escape.",
        terms={
            "κ": "The decay rate of an exponential law: the share of orbits still inside at time t is proportional to exp(−κ t).",
            "γ": "The exponent of a power law: the share of orbits still inside at time t is proportional to t^(−γ).",
        },
    ),
    Measure(
        "flux", "Flux", "how fast mixed motion leaves",
        _find_flux,
        (
            Quantity("flux", "flux through all exits", attrgetter("total")),
            Quantity(
                "mixed_decay_rate", "flux through all exits over the volume inside", attrgetter("decay_rate"),
                label="flux over volume",
            ),
        ),
        curve=Curve("rate"),
        sentence=_describe,
        place="through all exits",
        help="The flux through the exits over the phase-space volume inside: the rate at which orbits leave if the motion inside "
        "is mixed. Near islands orbits leave more slowly.",
    ),
    Measure(
        "uncertainty_exponent", "Uncertainty exponent", "how little better starts help",
        _find_exponent,
        (
            Quantity(
                "exponent", "uncertainty exponent", attrgetter("exponent", "low", "high"), Bars.INTERVAL, "α"
            ),
        ),
        curve=Curve("α", least_top=1.0),
        sentence=_describe,
        slow=True,
        place="in the whole view",
        help="The uncertainty exponent α, measured with new pairs of starts at each value. Near 0 a more accurate start "
        "hardly helps to predict the exit: the boundary nearly fills the plane. Near 1 boundaries are smooth. Bars are 95 "
        "% intervals.",
        terms={
            "Uncertainty exponent": "The exponent α of the share of uncertain starts, which is proportional to ε^α for an error "
            "ε of the start. The dimension of the boundary in the plane is 2 − α."
        },
    ),
    Measure(
        "chaotic_share", "Chaotic share", "how many bounded orbits are chaotic",
        _find_chaotic_share,
        (
            Quantity(
                "chaotic_share", "share of chaotic orbits among the bounded orbits", attrgetter("share", "low", "high"),
                Bars.INTERVAL, "of the bounded orbits",
            ),
        ),
        curve=Curve("share", least_top=1.0),
        sentence=_describe,
        slow=True,
        help="The share of the bounded orbits that are chaotic. They are sticky: they stay near the edge of an island, and may "
        "escape after t_max. Bars are 95 % intervals, as for independent random starts.",
    ),
    Measure(
        "accuracy", "Accuracy", "how well energy is conserved",
        lambda measured: measured.escape_map,
        (
            Quantity("worst_energy_error", "largest relative energy error of any orbit", attrgetter("worst_energy_error")),
        ),
    ),
    Measure("maps", "Maps", "the arrays of the maps", lambda measured: measured.escape_map, other_variables=_map_variables),
)  # fmt: skip


def _names_of(measure: Measure[Any]) -> list[str]:
    """Return the name of a measure and those of its numbers."""
    return [measure.name, *(quantity.name for quantity in measure.quantities)]


MEASURES: Mapping[str, Measure[Any]] = Entries(Group.MEASURES, Measure, _ENTRIES, names=_names_of)
"""The measures by name, with those of other packages."""


def curve_names(*, slow: bool = True) -> tuple[str, ...]:
    """Return the names of the measures that are drawn as curves against the energy or a parameter.

    Without `slow`, only those that take little time in addition to the map.
    """
    return tuple(name for name, measure in MEASURES.items() if measure.curve != NO_CURVE and (slow or not measure.slow))
