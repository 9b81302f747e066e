"""What stands around a printed picture: axes with round numbers, the colour bar, the legend, in a font that is always there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from decimal import Decimal
from functools import cache
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from app.rendering.image_columns import longest_typical_time
from app.rendering.map_images import time_colours
from app.rendering.palette import LIGHT, PATCH_EDGE, Entry, Palette
from engine import EscapeMap

WHITE = (255, 255, 255)

_FEWEST_TICKS = 3
# Steps below this power of ten are written as distances from the middle: their digits would run into each other.
_FINEST_PLAIN_STEP = -4
# What the built-in font lacks, as it is typed.
_TYPED = str.maketrans({"–": "-", "—": "-", "−": "-", "×": "x", "²": "^2", "½": "1/2", "≤": "<=", "≥": ">=", "→": "->"})


class Axis(NamedTuple):
    """Name of an axis, and for each tick its place, 0 to 1 along the axis, and its label."""

    name: str
    ticks: list[tuple[float, str]]


def label_axis(name: str, low: float, high: float) -> Axis:
    """Ticks at multiples of 1, 2 or 5 · 10^k between two numbers, three to eight of them, exact to the last digit.

    Where they are less than 1e-4 apart, the labels are distances from the middle one, and the axis' name says so.
    """
    most = (high - low) / _FEWEST_TICKS
    exponent = math.floor(math.log10(most))
    step = Decimal(next((m for m in (5, 2) if m * 10.0**exponent <= most), 1)).scaleb(exponent)
    numbers = range(math.ceil(Decimal(low) / step), math.floor(Decimal(high) / step) + 1)
    values = [number * step for number in numbers]
    labels = [f"{value:f}" for value in values]
    if exponent < _FINEST_PLAIN_STEP:
        middle = values[len(values) // 2]
        labels = [f"{(value - middle).scaleb(-exponent):f}" for value in values]
        offset = f"({name} {'-' if middle > 0 else '+'} {abs(middle):f})" if middle else name
        name = f"{offset} / 1e{exponent}"
    return Axis(name, [(float(value - Decimal(low)) / (high - low), label) for value, label in zip(values, labels, strict=True)])


def draw_panel(frame: EscapeMap, square: Image.Image, title: str, size: int) -> tuple[Image.Image, int]:
    """Title, map and axes; and where the map's left edge is."""
    window, side, font = frame.spec.window, square.width, font_of(size)
    across, up = (
        label_axis("x", window.x_low, window.x_high),
        label_axis(frame.spec.plane.ordinate, window.ordinate_low, window.ordinate_high),
    )
    left = round(2.8 * size + max(font.getlength(label) for _, label in up.ticks))
    top, tick = 2 * size, size // 3
    # Wide enough for the longest line of a legend.
    panel = Image.new("RGB", (left + max(side + 2 * size, 17 * size), top + side + 3 * size), WHITE)
    draw = ImageDraw.Draw(panel)
    draw.text((left, top // 2), title, LIGHT.text, font_of(round(1.2 * size)), "lm")
    line = max(1, size // 12)
    draw.rectangle((left - line, top - line, left + side + line - 1, top + side + line - 1), LIGHT.text, width=line)
    panel.paste(square, (left, top))
    _draw_ticks(draw, [(left + place * side, label) for place, label in across.ticks], top + side, size)
    draw.text((left + side / 2, top + side + 2.3 * size), typed(across.name), LIGHT.text, font, "mm")
    for place, label in up.ticks:
        y = top + (1 - place) * side
        draw.line((left - tick, y, left, y), LIGHT.text, line)
        draw.text((left - 1.5 * tick, y), label, LIGHT.text, font, "rm")
    name = Image.new("RGB", (side, round(1.4 * size)), WHITE)
    ImageDraw.Draw(name).text((side / 2, 0.7 * size), typed(up.name), LIGHT.text, font, "mm")
    panel.paste(name.transpose(Image.Transpose.ROTATE_90), (size // 2, top))
    return panel, left


def _draw_ticks(draw: ImageDraw.ImageDraw, ticks: list[tuple[float, str]], y: int, size: int) -> None:
    """Ticks below a line, with their labels; one that would run into another is left out."""
    taken: list[tuple[float, float]] = []
    for x, label in ticks:
        draw.line((x, y, x, y + size // 3), LIGHT.text, max(1, size // 12))
        half = 0.5 * font_of(size).getlength(label) + 0.2 * size
        if all(x + half < low or high < x - half for low, high in taken):
            draw.text((x, y + size // 2), label, LIGHT.text, font_of(size), "ma")
            taken.append((x - half, x + half))


def draw_colour_bar(frame: EscapeMap, palette: Palette, side: int, left: int, width: int, size: int) -> Image.Image:
    """The logarithmic scale of the escape times."""
    longest = longest_typical_time(frame)
    bar = Image.new("RGB", (width, round(3.4 * size)), WHITE)
    times = longest ** ((np.arange(side) + 0.5) / side)
    bar.paste(Image.fromarray(time_colours(times, longest, palette)[None]).resize((side, size // 2 * 2)), (left, size // 2))
    powers = [10.0**k for k in range(math.floor(math.log10(longest)) + 1)]
    between = [m * power for power in powers for m in (2.0, 5.0) if m * power < longest]
    marks = [*powers, longest, *between]
    ticks = [(left + side * math.log(mark) / math.log(longest), f"{mark:.0f}") for mark in dict.fromkeys(marks)]
    _draw_ticks(ImageDraw.Draw(bar), ticks, size // 2 + size // 2 * 2, size)
    return bar


def draw_flow(entries: Sequence[Entry], size: int, left: int, width: int, gap: int) -> Image.Image:
    """Entries in lines that wrap: a patch, where there is a colour, and the label."""
    font, patch, line = font_of(size), round(0.8 * size), round(1.5 * size)
    places: list[tuple[float, int]] = []
    x, row = float(left), 0
    for entry in entries:
        wide = font.getlength(typed(entry.label)) + (1.4 * patch if entry.colour else 0)
        if x > left and x + wide > width - size // 2:
            x, row = float(left), row + 1
        places.append((x, row))
        x += wide + gap
    image = Image.new("RGB", (width, (row + 1) * line + size // 2), WHITE)
    draw = ImageDraw.Draw(image, "RGBA")
    for entry, (x, row) in zip(entries, places, strict=True):
        middle = (row + 0.5) * line
        if entry.colour:
            box = (x, middle - patch / 2, x + patch, middle + patch / 2)
            draw.rectangle(box, entry.colour, PATCH_EDGE, max(1, size // 12))
            x += 1.4 * patch
        draw.text((x, middle), typed(entry.label), LIGHT.text, font, "lm")
    return image


@cache
def font_of(size: int) -> ImageFont.FreeTypeFont:
    """Pillow's built-in font in a size; `typed` replaces what it lacks."""
    font = ImageFont.load_default(size)
    assert isinstance(font, ImageFont.FreeTypeFont)
    return font


def typed(text: str) -> str:
    """Text in characters that Pillow's built-in font has: no Greek, no dashes, no fractions."""
    return text.translate(_TYPED)
