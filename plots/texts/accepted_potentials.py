"""Which potentials can be shown."""

from __future__ import annotations

from engine import PotentialReview
from engine.foundations.validation import LARGEST_NUMBER
from engine.systems.review.energy_ranges import HIGHEST_SHOWN
from plots.pictures.palette import MOST_CHANNELS, MOST_COLLISIONS


def refusal(found: PotentialReview) -> str | None:
    """Reason why the page cannot show a potential; None if it can."""
    if found.refusal is not None:
        return found.refusal
    potential = found.potential
    if found.channels > MOST_CHANNELS:
        return f"It has {found.channels} channels; the page has colours for {MOST_CHANNELS}."
    if len(potential.centres) > MOST_COLLISIONS:
        return f"It has {len(potential.centres)} centres; the page has colours for {MOST_COLLISIONS}."
    if potential.escape_radius is None and abs(potential.well.energy_at(HIGHEST_SHOWN)) > LARGEST_NUMBER:
        return f"Its escape energy is {found.escape_energy:.6g}; the page shows energies up to {LARGEST_NUMBER:g}."
    return None
