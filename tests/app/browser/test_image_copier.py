"""The server's side of the button; image_copier.test.js has the browser's."""

from __future__ import annotations

from typing import Any

import pytest

from app.browser.image_copier import ImageCopier


@pytest.fixture
def calls() -> list[Any]:
    return []


@pytest.fixture
def copier(calls: list[Any]) -> ImageCopier:
    return ImageCopier(lambda: calls.append("wanted"), calls.append)


def test_clicks_and_success_are_reported(copier: ImageCopier, calls: list[Any]) -> None:
    for message in ({"wanted": True}, {"copied": True}, {"copied": False}):
        copier._receive(message)
    assert calls == ["wanted", True, False]


@pytest.mark.parametrize("message", [None, 3, {}, {"wanted": 1}, {"copied": "yes"}, {"image": None}])
def test_other_messages_are_ignored(copier: ImageCopier, calls: list[Any], message: Any) -> None:
    copier._receive(message)
    assert calls == []
