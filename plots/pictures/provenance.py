"""Texts about the origin of results: the version of this program, and a line about a map."""

from __future__ import annotations

import math
from importlib import metadata

from engine import CASES, EscapeMap, Potential, Section
from engine.foundations.wording import format_number


def program_version() -> str:
    """Return the name and the version of this program, for the metadata of files."""
    return f"escape-explorer {metadata.version('escape-explorer')}"


def provenance_line(frame: EscapeMap) -> str:
    """Describe a map in one line: potential with rotation and ends, h, plane, window, resolution, t_max and version."""
    spec = frame.spec
    plane = spec.plane
    window = spec.find_window()
    name = spec.potential.name
    columns, rows = spec.resolution
    energy = [] if spec.common_energy is None else [f"h = {spec.common_energy!r}"]
    abscissa, ordinate = plane.axis_symbols
    facts = [
        f"{'Case' if name in CASES else 'Potential'} {name}",
        *_system_facts(spec.potential),
        *energy,
        f"plane {plane.title}",
        *([] if spec.section == Section.Y_UP else [f"section {spec.section.text}"]),
        f"{abscissa} from {_write_ends(window.x_low, window.x_high)}",
        f"{ordinate} from {_write_ends(window.ordinate_low, window.ordinate_high)}",
        f"{columns} × {rows} starts",
        f"t_max = {spec.t_max:g}",
        *(["backward in time"] if spec.backward else []),
        *([] if frame.complete else ["not finished"]),
        f"escape-explorer {frame.provenance()['version']}",
    ]
    return ", ".join(facts)


def _system_facts(potential: Potential) -> list[str]:
    """Return the rotation and the ends of a system in words."""
    facts = [f"Ω = {format_number(potential.rotation)}"] if potential.rotation else []
    return [*facts, *(end.geometry for end in potential.ends)]


def _write_ends(low: float, high: float) -> str:
    """Write both ends of an axis, with enough digits to resolve a ten-thousandth of its length."""
    digits = 4 + math.ceil(math.log10(max(1.0, abs(low), abs(high)) / (high - low)))
    return " to ".join(format_number(end, max(digits, 6)) for end in (low, high))
