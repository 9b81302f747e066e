"""What nobody has set on a model of Bokeh's, looked up once for its kind.

To build a page, Bokeh asks its 750 models for all their properties many times, and most of these are as they come. It works out,
copies and checks each default at each look, which is a quarter of the time that a page takes while all other visitors wait.
"""

from __future__ import annotations

from typing import Any

from bokeh.core.has_props import HasProps
from bokeh.core.property.descriptors import PropertyDescriptor
from bokeh.core.property.singletons import UndefinedType

from app.bokeh_patches.own_ways import put_in_place

_UNCHANGING = (int, float, str, bool, type(None), UndefinedType)
"""Types whose values any number of models may share."""

_KNOWN = "__known_defaults__"
_UNSTABLE = "__unstable_defaults__"

_their_default: Any = getattr(PropertyDescriptor, "_get_default", None)
_their_unstable = PropertyDescriptor.has_unstable_default


def look_defaults_up_once() -> None:
    """From now on, in this process."""
    put_in_place(HasProps, "themed_values", themed_values)
    put_in_place(PropertyDescriptor, "_get_default", default)
    put_in_place(PropertyDescriptor, "has_unstable_default", is_unstable)


def themed_values(model: Any) -> dict[str, Any] | None:
    """What a theme sets on a model, None without one; as Bokeh's, which raises and catches an error to see that."""
    return vars(model).get("__themed_values__")  # type: ignore[no-any-return]


def default(descriptor: Any, model: Any) -> Any:
    """A property's value on a model that has none of its own; as Bokeh's, and the same object for all where it cannot change."""
    name, themed = descriptor.name, model.themed_values()
    if themed is not None and name in themed:
        return _their_default(descriptor, model)
    known = _of_kind(model, _KNOWN)
    if name in known:
        return known[name]
    value = _their_default(descriptor, model)
    if type(value) in _UNCHANGING and not descriptor.has_unstable_default(model):
        known[name] = value
    return value


def is_unstable(descriptor: Any, model: Any) -> bool:
    """Whether each model has a default of its own; as Bokeh's."""
    known = _of_kind(model, _UNSTABLE)
    name = descriptor.name
    if name not in known:
        known[name] = _their_unstable(descriptor, model)
    return known[name]  # type: ignore[no-any-return]


def _of_kind(model: Any, what: str) -> dict[str, Any]:
    """What is known of the models of one class; kept there, and gone with it."""
    kind = type(model)
    known: dict[str, Any] | None = kind.__dict__.get(what)
    if known is None:
        known = {}
        type.__setattr__(kind, what, known)
    return known
