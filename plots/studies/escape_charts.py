"""Charts of the statistics of escapes: of one map, and of maps at several energies (Zotos 2014, section 5).

Ne of N0 starts escape, Nde of them without a crossing, and dN_n after n crossings, a share p_n of those still inside.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from engine.results import EscapeStatistics
from engine.systems.catalogue.published_fits import PaperFits
from plots.pictures.charts import Chart, Frame, Series, Shape
from plots.pictures.palette import MEASURED, THRESHOLD, value_colours

BINS = 40
"""Number of bins of the histogram of escape times."""

MOST_CROSSINGS = 15
"""Largest number of crossings for which the escape probability is shown."""

MOST_LISTED_CROSSINGS = 40
"""Upper end of the axis of crossings in charts of several energies. Few orbits escape after more crossings."""

FEWEST_REMAINING = 50
"""Smallest number of remaining starts for which p_n of several energies is drawn. With fewer, p_n depends on the grid."""

# Number of points of a fitted curve.
_FIT_POINTS = 200

TIMES = Frame(
    "histogram",
    "Escape times",
    ("escape time", "starts"),
    "How many starts escape when. Each bin spans the same factor of time. The peak is the typical escape time. The tail on the "
    "right comes from fractal boundaries and from orbits that stick to islands. Bounded orbits are not included.",
    "<b>@top{count} starts</b> escape<br>from t = @left{number} to @right{number}",
    Shape.BARS,
    logarithmic="x",
)
PROBABILITIES = Frame(
    "probabilities",
    "Escapes after n crossings",
    ("crossings n", "share that leaves"),
    "Of the orbits that have not escaped at their n-th crossing of the section, the share that escapes before the next one; "
    "n = 0 is the share of direct escapes. If the motion inside the well were well mixed, the probability would be the same for "
    "all n. Bounded orbits stay in the count, so if there are any, it tends to zero.",
    "n = $x{count} crossings:<br><b>@top{percent}</b> of the orbits still inside<br>escape before the next one",
    Shape.BARS,
)
ESCAPES = Frame(
    "escapes",
    "Escapes against energy",
    ("h", "share of the starts"),
    "The share Ne/N0 of the interior starts that escape, and the share Nde/N0 that escape directly, without a crossing of the "
    "section. On (x, pₓ) of the cases of Zotos (2014), dashed lines are the curves fitted there.",
    "<b>@y{percent}</b>: @label<br>at h = @x{number}",
)
ESCAPES_BY_CROSSINGS = Frame(
    "escapes_by_crossings",
    "Escapes by crossings",
    ("crossings n", "dNₙ/N₀"),
    "The share dNₙ/N₀ of the interior starts that escape after n crossings of the section, on a logarithmic axis, with a line "
    "for each energy. A straight line is an exponential decay; a line that bends upward comes from orbits that stick to islands.",
    "<b>$snap_y{percent}</b> of the starts escape<br>after n = $snap_x{count} crossings, @label",
    Shape.LINE,
    logarithmic="y",
)
PROBABILITIES_BY_ENERGY = Frame(
    "probabilities_by_energy",
    "Probability of escape",
    ("crossings n", "pₙ"),
    "Of the orbits that have not escaped at their n-th crossing, the share pₙ that escapes before the next one, with a line for "
    f"each energy, while at least {FEWEST_REMAINING} orbits are inside. In well mixed motion pₙ tends to a constant.",
    "<b>$snap_y{percent}</b> of the orbits still inside escape<br>after n = $snap_x{count} crossings, @label",
    Shape.LINE,
)


def times_chart(statistics: EscapeStatistics) -> Chart:
    """Return the histogram of the escape times."""
    edges, counts = statistics.time_histogram(BINS)
    bars = Series("", MEASURED, np.sqrt(edges[:-1] * edges[1:]), counts, Shape.BARS, (edges[:-1], edges[1:]))
    return Chart(TIMES, [bars], ((edges[0], edges[-1]), (0.0, 1.05 * max(float(counts.max()), 1.0))))


def probabilities_chart(statistics: EscapeStatistics) -> Chart:
    """Return the chart of the escape probability after each number of crossings."""
    probabilities = statistics.escape_probabilities[: MOST_CROSSINGS + 1]
    n = np.arange(probabilities.size, dtype=float)
    bars = Series("", MEASURED, n, probabilities, Shape.BARS, (n - 0.5, n + 0.5))
    highest = max(probabilities, default=0.0) or 1.0
    return Chart(PROBABILITIES, [bars], ((-0.6, MOST_CROSSINGS + 0.6), (0.0, 1.05 * float(highest))))


def escapes_chart(by_energy: Mapping[float, EscapeStatistics], fits: PaperFits | None) -> Chart:
    """Return the chart of Ne/N0 and Nde/N0 against h, with published fits if there are any."""
    h = np.array([*by_energy])
    escaped = np.array([each.escaped / each.starts if each.starts else 0.0 for each in by_energy.values()])
    direct = np.array([each.direct_share for each in by_energy.values()])
    shares = (("escape", MEASURED, escaped), ("escape directly", value_colours(3)[1], direct))
    series = [Series(label, colour, h, share, Shape.JOINED_POINTS) for label, colour, share in shares]
    if fits is not None:
        energies = np.linspace(h[0], h[-1], _FIT_POINTS)
        curves = (("fits of Zotos (2014)", fits.escaped), ("", fits.direct))
        series += [Series(label, THRESHOLD, energies, fit(energies), Shape.DASHED) for label, fit in curves]
    return Chart(ESCAPES, series, (None, (0.0, 1.0)))


def crossing_charts(by_energy: Mapping[float, EscapeStatistics]) -> list[Chart]:
    """Return the charts of dN_n/N0 and of p_n against n, with a line for each energy."""
    # The ends of the scale of colours have too little contrast with dark and light pages.
    colours = value_colours(len(by_energy) + 2)[1:-1]
    shares, probabilities = [], []
    for (energy, statistics), colour in zip(by_energy.items(), colours, strict=True):
        escapes = statistics.crossing_counts[: MOST_LISTED_CROSSINGS + 1]
        remaining = statistics.decided - np.cumsum(escapes) + escapes
        label, n = f"h = {energy:g}", np.arange(escapes.size, dtype=float)
        # A logarithmic axis cannot show 0.
        shares.append(Series(label, colour, n, np.where(escapes > 0, escapes / max(statistics.starts, 1), np.nan)))
        known = np.where(remaining >= FEWEST_REMAINING, statistics.escape_probabilities[: escapes.size], np.nan)
        probabilities.append(Series(label, colour, n, known))
    limits = (-0.5, MOST_LISTED_CROSSINGS + 0.5)
    return [Chart(ESCAPES_BY_CROSSINGS, shares, (limits, None)), Chart(PROBABILITIES_BY_ENERGY, probabilities, (limits, None))]
