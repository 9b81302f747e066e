"""Mirror symmetries of a well with its ends: reflections that map orbits onto orbits, and their effect on fates."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from engine.systems.forms.expression_form import Form
from engine.systems.landscape.mirror_images import IDENTITY, Signs, find_images, mirrors_of
from engine.systems.outcomes import End


def well_mirrors(form: Form, rotation: float, ends: Sequence[End]) -> tuple[Signs, ...]:
    """Return the reflections that map V and the ends onto themselves, in a frame at rest."""

    def maps_ends(signs: Signs) -> bool:
        return {end.image(signs) for end in ends} == {end.image(IDENTITY) for end in ends}

    return () if rotation else tuple(signs for signs in mirrors_of(form) if maps_ends(signs))


def image_fates(saddles: np.ndarray, ends: Sequence[End], signs: Signs) -> np.ndarray:
    """Return the fate onto which a reflection maps each fate, int8, of shape (outcomes + 1,). Entry 0 is 0."""
    ends_by_kind = [np.array([end.place for end in group]) for _, group in groupby(ends, type)]
    images = [np.arange(1)]
    for points in (saddles, *ends_by_kind):
        # The fates of a kind follow those of the previous kinds.
        images.append(sum(map(len, images)) + find_images(points, signs))
    return np.concatenate(images).astype(np.int8)
