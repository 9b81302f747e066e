"""Integer codes of results in words, and what they mean in files."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum


def describe_codes(codes: type[IntEnum], labels: Sequence[str] = ()) -> dict[str, str]:
    """The dataset attribute that explains integer codes: ``{"codes": "value: name; …"}``.

    `labels` name the codes from 1 on that are not members of the enumeration, such as the outcomes of a `Fate`. The attribute
    leaves them out if they are the default ones, "channel 1" and so on.
    """
    known = [f"{code.value}: {code.name.lower()}" for code in codes]
    are_channels = all(label == _channel(code) for code, label in enumerate(labels, 1))
    return {"codes": "; ".join([*known, *([] if are_channels else (f"{k}: {label}" for k, label in enumerate(labels, 1)))])}


def name_code(codes: type[IntEnum], code: int, labels: Sequence[str] = ()) -> str:
    """Return a code in words; `labels` name the codes from 1 on that are not members, which otherwise are channels."""
    if code in codes:
        return codes(code).name.lower().replace("_", " ")
    return labels[code - 1] if 1 <= code <= len(labels) else _channel(code)


def _channel(code: int) -> str:
    return f"channel {code}"
