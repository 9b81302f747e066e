"""The parts of the report on curves: the paper's fits beside ours, and the laws by which the last starts leave."""

from __future__ import annotations

from collections.abc import Iterator

from engine import (
    CASES,
    PAPER_FITS,
    HyperbolicTangent,
    Plane,
    Polynomial,
    ShareFit,
    compute_statistics,
    fit_decay_laws,
    fit_direct_shares,
    fit_escape_shares,
    measure_deviation,
)
from reproduction.map_shelf import MapShelf
from reproduction.markdown import write_rows
from reproduction.paper_ranges import three_energies

_FITS = """\
{count} energies each, evenly from the lowest of the paper's maps to where its curves end; starts inside, on (x, px). The
intervals hold 95 %, and allow for the forms being conventions that the data depart from systematically."""

_LAWS = """\
S(t) is the share of the starts inside, on (x, px), that have not left by t; a law is fitted from where it first holds
([escape laws](escape-laws.md))."""


def write_fits(shelf: MapShelf) -> str:
    """A row for each parameter of each fit, with its interval, and how far either curve is from the data."""
    rows, sentences = [], []
    for case in CASES:
        table, paper = shelf.curves(case, Plane.X_PX), PAPER_FITS[case]
        h, starts = table["h"].values, table["starts"].values
        degree = len(paper.direct.coefficients) - 1
        curves: tuple[tuple[str, str, HyperbolicTangent | Polynomial, ShareFit], ...] = (
            ("Ne/N0", "escaped", paper.escaped, fit_escape_shares(h, table["escaped"].values, starts)),
            ("Nde/N0", "direct", paper.direct, fit_direct_shares(h, table["direct"].values, starts, degree)),
        )
        for name, counts, theirs, ours in curves:
            rows += list(_fit_rows(f"{case}, {name}", theirs, ours))
            off = measure_deviation(theirs, h, table[counts].values, starts)
            sentences.append(f"- Case {case}, {name}: the paper's curve lies {off.describe()}; ours {ours.deviation.describe()}.")
    intro = _FITS.format(count=shelf.quality.curve_points)
    heads = ("fit", "parameter", "paper", "ours", "95 % interval", "paper's inside")
    return "\n\n".join([intro, write_rows(heads, rows), "\n".join(sentences)])


def _fit_rows(name: str, theirs: HyperbolicTangent | Polynomial, ours: ShareFit) -> Iterator[tuple[str, ...]]:
    for parameter, value in theirs.parameters.items():
        low, high = ours.intervals[parameter]
        inside = "yes" if low <= value <= high else "no"
        yield (
            name,
            parameter,
            _written(value),
            _written(ours.curve.parameters[parameter]),
            f"{_written(low)} to {_written(high)}",
            inside,
        )


def write_laws(shelf: MapShelf) -> str:
    """Which law describes the late escapes, at three energies of each case."""
    rows = []
    for case in CASES:
        for energy in three_energies(case):
            statistics = compute_statistics(shelf.map(case, Plane.X_PX, energy))
            laws = fit_decay_laws(statistics, shelf.quality.t_max, cancel=shelf.cancel)
            verdict = str(laws.preferred) if laws.preferred is not None else "none"
            rows.append((case, f"{energy:g}", verdict, laws.describe()))
    return "\n\n".join([_LAWS, write_rows(("case", "h", "law", "in full"), rows)])


def _written(number: float) -> str:
    return f"{number:.4g}".replace("-", "−").replace("inf", "∞")
