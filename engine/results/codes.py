"""Integer codes of results in words, and what they mean in files."""

from __future__ import annotations

from enum import IntEnum


def describe_codes(codes: type[IntEnum]) -> dict[str, str]:
    """The dataset attribute that explains integer codes: ``{"codes": "value: name; …"}``."""
    return {"codes": "; ".join(f"{code.value}: {code.name.lower()}" for code in codes)}


def name_code(codes: type[IntEnum], code: int) -> str:
    """A code in words; those above 0 that are no members are channels, as in `Fate`."""
    return codes(code).name.lower().replace("_", " ") if code in codes else f"channel {code}"
