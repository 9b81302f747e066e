"""Limits of the charts of the statistics, on the page and in files."""

BINS = 40
"""Number of bins of the histogram of escape times."""

MOST_CROSSINGS = 15
"""Largest number of crossings for which the escape probability is shown."""
