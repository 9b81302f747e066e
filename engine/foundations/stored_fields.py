"""Fields of results in files, and their names in earlier versions. Files contain numbers and texts unchanged, others as JSON."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from enum import Enum
from types import NoneType, UnionType
from typing import TYPE_CHECKING, Any, Union, get_args, get_origin, get_type_hints

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.validation import short_repr

if TYPE_CHECKING:
    import xarray as xr

FORMER_FIELDS: Mapping[str, str] = {"certificate": "evidence", "certify": "use_evidence", "certifies_tori": "tori_are_evidence"}
"""Names of variables and attributes in files of earlier versions, with the present ones."""


def with_present_names(dataset: xr.Dataset) -> xr.Dataset:
    """Return a dataset of any version with the present names of its variables and attributes."""
    renamed = dataset.rename({old: new for old, new in FORMER_FIELDS.items() if old in dataset.variables})
    renamed.attrs = {FORMER_FIELDS.get(name, name): value for name, value in dataset.attrs.items()}
    return renamed


def checked_dataset(name: str, value: Any, arrays: Collection[str], legal: str) -> xr.Dataset:
    """Return the dataset of one map, or of any orbits, with the present names; ValueError unless it has these arrays.

    Parameters
    ----------
    name
        Name of the parameter, for messages.
    value
        The dataset, of any version, or what was given instead of a dataset.
    arrays
        The names of the required arrays, among them "fate".
    legal
        Description of what is legal, for messages.
    """
    # Any other value counts as a dataset without arrays.
    dataset: Any = with_present_names(value) if hasattr(value, "data_vars") else {}
    if "fate" not in dataset:
        raise ValueError(f"{name}={short_repr(value)}: must be {legal}")
    missing = [array for array in arrays if array not in dataset]
    if missing:
        raise ValueError(f"{name}: a dataset of a map without {', '.join(missing)}; must have all arrays of the map")
    if dataset["fate"].ndim > 2:
        raise ValueError(f"{name}: a dataset of several maps; must be one of them, such as dataset.sel(h=…)")
    return dataset


@contextmanager
def content_named(label: str) -> Iterator[None]:
    """Raise a ValueError that begins with a label, such as the path, for content of a file that is not that of a result."""
    try:
        yield
    except (ValueError, KeyError, TypeError, AttributeError, RuntimeError, StopIteration) as error:
        problem = f"{label}: cannot be read as a result ({error!r})"
        raise ValueError(f"{problem}; must hold what this library has written") from error


def write_field(value: Any) -> Any:
    """Convert a value to an attribute of a file, from which `read_field` restores the value."""
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, bool):
        return int(value)
    return value if isinstance(value, int | float | str) else json.dumps(value, default=_to_json)


def _to_json(value: Any) -> Any:
    """Convert a dataclass instance or an enumeration member to a value that JSON supports."""
    if is_dataclass(value):
        return {field.name: getattr(value, field.name) for field in fields(value)}
    if isinstance(value, Enum):
        return value.value
    raise TypeError(f"{type(value).__name__} cannot be written to a file")


def read_field(hint: Any, content: Any) -> Any:
    """Restore a value of type `hint` from the content of a file: an array, a number, a text, or JSON."""
    if hint is np.ndarray:
        return read_only(np.array(content))
    hint = _without_none(hint)
    scalar = content if isinstance(content, str) else np.asarray(content).item()
    return _build(hint, json.loads(scalar) if get_origin(hint) is tuple or is_dataclass(hint) else scalar)


def _without_none(hint: Any) -> Any:
    """Return a type without the alternative None."""
    if get_origin(hint) not in (Union, UnionType):
        return hint
    return next(kind for kind in get_args(hint) if kind is not NoneType)


def _build(hint: Any, plain: Any) -> Any:
    """Build a value of type `hint` from numbers, texts, lists and mappings."""
    if plain is None:
        return None
    hint = _without_none(hint)
    if get_origin(hint) is tuple:
        arguments = get_args(hint)
        item_hints = arguments[:1] * len(plain) if arguments[-1] is Ellipsis else arguments
        return tuple(_build(item_hint, item) for item_hint, item in zip(item_hints, plain, strict=True))
    if is_dataclass(hint):
        hints = get_type_hints(hint)
        return hint(**{name: _build(hints[name], value) for name, value in plain.items()})  # type: ignore[operator]
    return hint(plain)


def plain_attributes(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """Convert attributes read from a file: NumPy numbers to Python numbers, arrays and lists to tuples."""
    return {str(name): _plain_attribute(value) for name, value in attributes.items()}


def _plain_attribute(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    return tuple(value) if isinstance(value, list) else value
