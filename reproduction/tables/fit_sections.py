"""Write the sections of the report on fits of shares against energy and on decay laws."""

from __future__ import annotations

from collections.abc import Iterator

from engine import CASES, Plane, compute_statistics, fit_decay_laws
from engine.foundations.wording import format_number
from engine.systems.catalogue.published_fits import ShareCurve
from reproduction.map_cache import MapCache
from reproduction.notation import write_rows
from reproduction.numbers.share_fits import ShareFit, fit_case, measure_deviation
from reproduction.paper_ranges import three_energies

_FITS_INTRODUCTION = """\
{count} evenly spaced energies each, from the lowest energy of the paper's maps to the end of its curves; starts inside, on
(x, px). The 95 % intervals allow for systematic deviations of the data from the fitted forms."""

_LAWS_INTRODUCTION = """\
S(t) is the share of the starts inside, on (x, px), that have not escaped by t; a law is fitted from the time from which it
holds."""


def write_fits(cache: MapCache) -> str:
    """Return a table of the fitted parameters with intervals, and the deviations of the published and new curves."""
    rows, sentences = [], []
    for case in CASES:
        for fit in fit_case(case, cache.curves(case, Plane.X_PX)):
            rows += list(_fit_rows(f"{case}, {fit.name}", fit.published, fit.fitted))
            paper_deviation = measure_deviation(fit.published, fit.h, fit.shares).describe()
            new_deviation = fit.fitted.deviation.describe()
            sentences.append(f"- Case {case}, {fit.name}: the paper's curve lies {paper_deviation}; the new fit {new_deviation}.")
    introduction = _FITS_INTRODUCTION.format(count=cache.quality.curve_points)
    headings = ("fit", "parameter", "paper", "new fit", "95 % interval", "paper's inside")
    return "\n\n".join([introduction, write_rows(headings, rows), "\n".join(sentences)])


def _fit_rows(name: str, published: ShareCurve, fitted: ShareFit) -> Iterator[tuple[str, ...]]:
    """Yield a row for each parameter of a fit."""
    for parameter, value in published.parameters.items():
        low, high = fitted.intervals[parameter]
        inside = "yes" if low <= value <= high else "no"
        yield (
            name,
            parameter,
            format_number(value),
            format_number(fitted.curve.parameters[parameter]),
            f"{format_number(low)} to {format_number(high)}",
            inside,
        )


def write_laws(cache: MapCache) -> str:
    """Return a table of the preferred decay laws at three energies of each case."""
    rows = []
    for case in CASES:
        for energy in three_energies(case):
            statistics = compute_statistics(cache.map(case, Plane.X_PX, energy))
            laws = fit_decay_laws(statistics)
            verdict = str(laws.preferred) if laws.preferred is not None else "none"
            rows.append((case, f"{energy:g}", verdict, laws.describe()))
    return "\n\n".join([_LAWS_INTRODUCTION, write_rows(("case", "h", "law", "in full"), rows)])
