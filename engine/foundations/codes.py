"""Integer codes of results in words, and what they mean in files."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum


def describe_codes(codes: type[IntEnum], labels: Sequence[str] = ()) -> dict[str, str]:
    """The dataset attribute that explains integer codes: ``{"codes": "value: name; …"}``.

    `labels` are those of the codes from 1 that are no members, as of `Fate`; where all are channels, as without labels, the
    attribute leaves them out.
    """
    known = [f"{code.value}: {code.name.lower()}" for code in codes]
    are_channels = all(label == _channel(code) for code, label in enumerate(labels, 1))
    return {"codes": "; ".join([*known, *([] if are_channels else (f"{k}: {label}" for k, label in enumerate(labels, 1)))])}


def name_code(codes: type[IntEnum], code: int, labels: Sequence[str] = ()) -> str:
    """A code in words; `labels` are those of the codes from 1 that are no members, channels where there is none."""
    if code in codes:
        return codes(code).name.lower().replace("_", " ")
    return labels[code - 1] if 1 <= code <= len(labels) else _channel(code)


def _channel(code: int) -> str:
    return f"channel {code}"
