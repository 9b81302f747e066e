"""Charts of the statistics of a map: the escape times, and the escape probabilities after each number of crossings."""

from __future__ import annotations

import numpy as np

from engine.results import EscapeStatistics
from plots.pictures.charts import Chart, Frame, Series, Shape
from plots.pictures.palette import MEASURED

BINS = 40
"""Number of bins of the histogram of escape times."""

MOST_CROSSINGS = 15
"""Largest number of crossings for which the escape probability is shown."""

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
