"""What the charts of the statistics show, on the page and in files."""

BINS = 40
"""Of the histogram of escape times."""

MOST_CROSSINGS = 15
"""The escape probability is shown up to this many crossings."""
