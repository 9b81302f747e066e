"""Write the sections of the report on fits of shares against energy and on decay laws."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from engine import CASES, Plane, compute_statistics, fit_decay_laws
from engine.foundations.wording import format_number
from reproduction.analyses.published_fits import PAPER_FITS, ShareCurve
from reproduction.analyses.share_fits import ShareFit, fit_direct_shares, fit_escape_shares, measure_deviation
from reproduction.map_cache import MapCache
from reproduction.notation import write_rows
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
        table = cache.curves(case, Plane.X_PX)
        paper = PAPER_FITS[case]
        h = table.values
        escaped = table["share"][:, 1:].sum(axis=1)
        direct = table["direct_share"]
        curves: tuple[tuple[str, np.ndarray, ShareCurve, ShareFit], ...] = (
            ("Ne/N0", escaped, paper.escaped, fit_escape_shares(h, escaped)),
            ("Nde/N0", direct, paper.direct, fit_direct_shares(h, direct, paper.direct.degree)),
        )
        for name, shares, published, fitted in curves:
            rows += list(_fit_rows(f"{case}, {name}", published, fitted))
            paper_deviation = measure_deviation(published, h, shares).describe()
            new_deviation = fitted.deviation.describe()
            sentences.append(f"- Case {case}, {name}: the paper's curve lies {paper_deviation}; the new fit {new_deviation}.")
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
