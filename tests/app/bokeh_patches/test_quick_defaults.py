"""What models have by default is what they have by Bokeh's own way, and theirs alone where it can change."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from bokeh.core.has_props import HasProps
from bokeh.core.property.descriptors import PropertyDescriptor
from bokeh.model import Model
from bokeh.models import Plot
from bokeh.themes import Theme

from app.bokeh_patches.quick_defaults import default, is_unstable, look_defaults_up_once, themed_values

THEIRS = {name: getattr(PropertyDescriptor, name) for name in ("_get_default", "has_unstable_default")}


@pytest.fixture
def in_place(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, method in THEIRS.items():
        monkeypatch.setattr(PropertyDescriptor, name, method)
    monkeypatch.setattr(HasProps, "themed_values", HasProps.themed_values)
    look_defaults_up_once()


def kinds() -> Iterator[type[Model]]:
    """All kinds of models that can be made out of nothing, Panel's among them; what is deprecated is left out."""
    for kind in Model.model_class_reverse_map.values():
        try:
            kind()
        except (TypeError, ValueError, RuntimeError, NotImplementedError, Warning):
            continue
        yield kind


def shown(value: Any) -> Any:
    """What can be compared: of a model its kind."""
    if isinstance(value, list):
        return [*map(shown, value)]
    return type(value) if isinstance(value, HasProps) else value


def test_every_default_is_bokeh_s() -> None:
    seen = 0
    for kind in kinds():
        one, other, theirs, theirs_too = kind(), kind(), kind(), kind()
        for name in kind.properties():
            descriptor = kind.lookup(name)
            is_other_name = not isinstance(descriptor, PropertyDescriptor)
            if is_other_name or any(name in model._property_values for model in (one, other, theirs, theirs_too)):
                continue
            ours = default(descriptor, one), default(descriptor, other)
            expected = THEIRS["_get_default"](descriptor, theirs), THEIRS["_get_default"](descriptor, theirs_too)
            assert [*map(shown, ours)] == [*map(shown, expected)], f"{kind.__name__}.{name}"
            assert is_unstable(descriptor, one) == THEIRS["has_unstable_default"](descriptor, one)
            can_change = isinstance(ours[0], list | dict | set | HasProps)
            assert not can_change or (ours[0] is ours[1]) == (expected[0] is expected[1]), f"{kind.__name__}.{name}"
            seen += 1
    assert seen > 5_000


@pytest.mark.usefixtures("in_place")
def test_a_theme_comes_and_goes() -> None:
    plot = Plot()
    before = plot.background_fill_color
    assert themed_values(plot) is None
    Theme(json={"attrs": {"Plot": {"background_fill_color": "#123456"}}}).apply_to_model(plot)
    assert plot.background_fill_color == "#123456"
    assert Plot().background_fill_color == before
    plot.unapply_theme()
    assert plot.background_fill_color == before


@pytest.mark.usefixtures("in_place")
def test_what_one_model_changes_in_place_no_other_has() -> None:
    one, other = Plot(), Plot()
    one.tags.append("mine")
    assert (one.tags, other.tags) == (["mine"], [])
