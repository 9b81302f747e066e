"""Check whether the page can show a potential."""

from __future__ import annotations

from collections import Counter

from engine.foundations.validation import LARGEST_NUMBER
from engine.results import PotentialReview
from engine.systems.review.energy_ranges import HIGHEST_SHOWN
from plots.pictures.palette import PAPER


def page_refusal(review: PotentialReview) -> str | None:
    """Return the reason why the page cannot show a potential; None if it can."""
    if review.refusal is not None:
        return review.refusal
    potential = review.potential
    for kind, count in Counter(outcome.kind for outcome in potential.outcomes).items():
        if count > (most := len(PAPER.of_kinds[kind.key])):
            return f"It has {count} {kind.word}s; the page has colours for {most}."
    if potential.channels and abs(potential.well.energy_at(HIGHEST_SHOWN)) > LARGEST_NUMBER:
        return f"Its escape energy is {review.escape_energy:.6g}; the page shows energies up to {LARGEST_NUMBER:g}."
    largest_energy = max(abs(review.energies.low), abs(review.energies.high))
    if largest_energy > LARGEST_NUMBER:
        return f"Its energies reach {largest_energy:.6g}; the page shows energies up to {LARGEST_NUMBER:g}."
    return None
