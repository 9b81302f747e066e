"""Build hook: the wheel has the packages of the repository below one namespace, with their imports adapted."""

from __future__ import annotations

import re
import shutil
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

NAMESPACE = "escape_explorer"
PACKAGES = ("app", "cli", "engine", "plots", "reproduction")

_NAMES = "|".join(PACKAGES)
_FROM = re.compile(rf"^(\s*from )(?=(?:{_NAMES})[. ])", re.MULTILINE)
_BY_NAME = re.compile(rf'((?:import_module|find_spec)\(")(?=(?:{_NAMES})[."])')
_PLAIN = re.compile(rf"^\s*import (?:{_NAMES})\b", re.MULTILINE)


class NamespaceHook(BuildHookInterface[Any]):
    """Put adapted copies of the packages into the wheel; an editable installation uses the repository as it is."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write the copies to a temporary folder."""
        if version == "editable":
            return
        self._folder = Path(tempfile.mkdtemp())
        for package in (*PACKAGES, NAMESPACE):
            target = self._folder / package
            shutil.copytree(Path(self.root, package), target, ignore=shutil.ignore_patterns("__pycache__"))
            for module in target.rglob("*.py"):
                module.write_text(adapt(module.read_text(encoding="utf-8"), str(module)), encoding="utf-8")
            build_data["force_include"][str(target)] = NAMESPACE if package == NAMESPACE else f"{NAMESPACE}/{package}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Delete the copies."""
        if version != "editable":
            shutil.rmtree(self._folder)


def adapt(source: str, name: str) -> str:
    """Prefix the imports of the packages by the namespace; ValueError for a form that is not handled."""
    if found := _PLAIN.search(source):
        raise ValueError(f"{name}: write 'from … import …' instead of '{found[0].strip()}'")
    prefix = rf"\g<1>{NAMESPACE}."
    return _BY_NAME.sub(prefix, _FROM.sub(prefix, source))
