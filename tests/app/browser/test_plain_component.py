"""Browsers run the code of components as it is."""

from __future__ import annotations

import param
import pytest
from panel.custom import JSComponent

from app.browser.components.file_components import FileSaver
from app.browser.components.orbit_components import OrbitPlayer
from app.browser.components.plain_component import PlainComponent

COMPONENTS = [each for each in param.concrete_descendents(JSComponent).values() if each.__module__.startswith("app.")]


@pytest.mark.parametrize("component", COMPONENTS, ids=lambda component: component.__name__)
def test_every_component_of_the_page_is_plain(component: type[JSComponent]) -> None:
    assert issubclass(component, PlainComponent)


def test_the_code_of_a_component_is_sent_as_that_of_a_bundle_of_its_own() -> None:
    first, again, other = (each.get_root() for each in (FileSaver(), FileSaver(), OrbitPlayer(print)))
    assert first.bundle == again.bundle != other.bundle
    assert None not in (first.bundle, other.bundle)
    assert "export function render" in first.esm
