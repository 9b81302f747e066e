"""What the charts of the statistics show, on the page and in files."""

BINS = 40
"""Number of bins of the histogram of escape times."""

MOST_CROSSINGS = 15
"""The escape probability is shown up to this many crossings."""
