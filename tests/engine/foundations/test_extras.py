"""A package that is missing is named, with the command that installs it."""

from __future__ import annotations

import pytest

from engine.foundations.extras import require_package


def test_a_missing_package_has_one_sentence() -> None:
    with pytest.raises(ModuleNotFoundError, match=r"^no_such_package is not installed: pip install 'escape-explorer\[files\]'$"):
        require_package("no_such_package", "files")
