"""Compute differences of colours as people with and without a colour-vision deficiency see them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PIL import ImageColor

VISIONS: dict[str, np.ndarray] = {
    "normal": np.eye(3),
    "deuteranopia": np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]),
    "protanopia": np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]),
}
"""Matrices on linear RGB, after Machado, Oliveira and Fernandes (2009), severity 1."""

_TO_XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])


def lab(colours: Sequence[str], vision: str = "normal") -> np.ndarray:
    """Return CIELAB coordinates, D65, of opaque colours, of shape (n, 3)."""
    encoded = np.array([ImageColor.getrgb(colour)[:3] for colour in colours]) / 255.0
    return lab_of_linear(_linear(encoded) @ VISIONS[vision].T)


def lab_of_linear(rgb: np.ndarray) -> np.ndarray:
    """Return CIELAB coordinates of linear RGB from 0 to 1, of shape (n, 3)."""
    xyz = np.clip(rgb, 0.0, 1.0) @ _TO_XYZ.T / _TO_XYZ.sum(axis=1)
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16.0 / 116.0)
    return np.stack([116.0 * f[:, 1] - 16.0, 500.0 * (f[:, 0] - f[:, 1]), 200.0 * (f[:, 1] - f[:, 2])], axis=-1)


def luminance(colour: str) -> float:
    """Return the relative luminance, 0 to 1, as in the WCAG."""
    return float(_linear(np.array(ImageColor.getrgb(colour)[:3]) / 255.0) @ _TO_XYZ[1])


def contrast(one: str, other: str) -> float:
    """Return the contrast ratio of the WCAG, 1 to 21."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def differences(ones: Sequence[str], others: Sequence[str], vision: str = "normal") -> np.ndarray:
    """Return the differences CIEDE2000 between colours, of shape (n, m)."""
    return ciede2000(lab(ones, vision)[:, None], lab(others, vision)[None])


def ciede2000(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the difference CIEDE2000 of CIELAB colours, after Sharma, Wu and Dalal (2005)."""
    one, other = np.broadcast_arrays(one, other)
    mean_chroma = 0.5 * (np.hypot(one[..., 1], one[..., 2]) + np.hypot(other[..., 1], other[..., 2]))
    stretch = 1.5 - 0.5 * np.sqrt(mean_chroma**7 / (mean_chroma**7 + 25.0**7))
    a, b = np.stack([one[..., 1] * stretch, other[..., 1] * stretch]), np.stack([one[..., 2], other[..., 2]])
    chroma, hue = np.hypot(a, b), np.degrees(np.arctan2(b, a)) % 360.0
    grey = chroma[0] * chroma[1] == 0.0
    turn = np.where(grey, 0.0, (hue[1] - hue[0] + 180.0) % 360.0 - 180.0)
    middle = np.where(grey, hue.sum(axis=0), hue[0] + 0.5 * turn)
    c, lightness = chroma.mean(axis=0), 0.5 * (one[..., 0] + other[..., 0])
    weight = (
        1.0
        - 0.17 * _cos(middle - 30.0)
        + 0.24 * _cos(2.0 * middle)
        + 0.32 * _cos(3.0 * middle + 6.0)
        - 0.20 * _cos(4.0 * middle - 63.0)
    )
    off = (lightness - 50.0) ** 2
    d_l = (other[..., 0] - one[..., 0]) / (1.0 + 0.015 * off / np.sqrt(20.0 + off))
    d_c = (chroma[1] - chroma[0]) / (1.0 + 0.045 * c)
    d_h = 2.0 * np.sqrt(chroma[0] * chroma[1]) * np.sin(np.radians(turn) / 2.0) / (1.0 + 0.015 * c * weight)
    angle = 30.0 * np.exp(-((((middle % 360.0) - 275.0) / 25.0) ** 2))
    rotation = -2.0 * np.sqrt(c**7 / (c**7 + 25.0**7)) * np.sin(np.radians(2.0 * angle))
    difference: np.ndarray = np.sqrt(d_l**2 + d_c**2 + d_h**2 + rotation * d_c * d_h)
    return difference


def _cos(degrees: np.ndarray) -> np.ndarray:
    cosine: np.ndarray = np.cos(np.radians(degrees))
    return cosine


def _linear(encoded: np.ndarray) -> np.ndarray:
    linear: np.ndarray = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return linear
