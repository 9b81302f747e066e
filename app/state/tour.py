"""The tour of the page: the text of each step, and the parts of the page that it is about."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class TourPart(StrEnum):
    """A part of the page that a step is about. The values are the names in app/browser/modules/gestures/tour.js."""

    MAP = "map"
    WELL = "well"
    ENERGY = "energy"
    ANALYSIS = "analysis"


@dataclass(frozen=True)
class TourStep:
    """A step of the tour: its title, its text, and the parts it is about. In narrow windows only the first part has a frame."""

    title: str
    text: str
    about: tuple[TourPart, ...]


TOUR = (
    TourStep(
        "What a pixel is",
        "Each point of the basins is the start of an orbit. Its colour is that of the exit through which the orbit leaves.",
        (TourPart.MAP,),
    ),
    TourStep(
        "How to read the maps",
        "Point at a start, or rest a finger on it: its path is drawn in the well, in the colour of its exit. A dotted line joins "
        "the start and its path.",
        (TourPart.MAP, TourPart.WELL),
    ),
    TourStep(
        "Change the energy",
        "Drag the energy: the picture on the slider shows how the starts divide among the exits at each energy. Below the energy "
        "at which the first exit opens, no orbit leaves.",
        (TourPart.ENERGY,),
    ),
    TourStep(
        "Keep an orbit",
        "Click a start: its orbit stays, with a sentence that says where and when it leaves. SALI shows whether it is chaotic, "
        "and R², the squared distance from the origin, how far out it moves.",
        (TourPart.MAP, TourPart.WELL, TourPart.ANALYSIS),
    ),
    TourStep(
        "Why the boundaries are fractal",
        "Turn the wheel over a boundary, or pinch it: new boundaries appear, because orbits that start close together separate "
        "exponentially. Click a start there, and “Add this neighbour” shows an orbit from close by that ends elsewhere.",
        (TourPart.MAP,),
    ),
)
"""The steps, in order."""

TOUR_TITLE = "A tour in five steps"
"""Title of the card that starts the tour."""

TOUR_LINE = "Pixels, energies, orbits, fractals"
"""The line below this title."""
