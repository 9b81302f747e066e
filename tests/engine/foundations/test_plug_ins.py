"""Tables have the entries of other packages, and leave out those that fail."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from engine.foundations.plug_ins import Entries, PlugInWarning
from tests.packages import install

GROUP = "escape_explorer.numbers"


@dataclass(frozen=True)
class Number:
    name: str
    value: int
    alias: str = ""


OWN = Number("one", 1, "unit")
Install = Callable[[str, Mapping[str, str]], None]


def table() -> Entries[Number]:
    return Entries(GROUP, Number, [OWN], names=lambda number: {number.name, number.alias} - {""}, reserved=["zero"], check=check)


def check(number: Number) -> None:
    if number.value < 0:
        raise ValueError(f"value={number.value}: must be 0 or more")


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Install:
    """Installs a package with one module, given its source and its entry points."""
    module = f"numbers_of_{abs(hash(request.node.name))}"

    def install_package(source: str, points: Mapping[str, str]) -> None:
        head = f"from {__name__} import Number, OWN\n"
        install(tmp_path, "numbers-of-others", {module: head + source}, {GROUP: {k: f"{module}:{v}" for k, v in points.items()}})
        monkeypatch.syspath_prepend(tmp_path)

    return install_package


def test_entries_of_packages_follow_those_of_the_program(package: Install) -> None:
    package("TWO = Number('two', 2)\nTHREE = Number('three', 3)", {"two": "TWO", "three": "THREE"})
    numbers = table()
    assert list(numbers) == ["one", "two", "three"]
    assert [number.value for number in numbers.values()] == [1, 2, 3]
    assert "four" not in numbers


def test_a_package_is_imported_at_the_first_look_up(package: Install, tmp_path: Path) -> None:
    package(f"open({str(tmp_path / 'imported')!r}, 'w').close()\nTWO = Number('two', 2)", {"two": "TWO"})
    numbers = table()
    assert not (tmp_path / "imported").exists()
    assert numbers["two"].value == 2
    assert (tmp_path / "imported").exists()


@pytest.mark.parametrize(
    ("source", "problem"),
    [
        ("raise RuntimeError('it is Monday')", "RuntimeError: it is Monday"),
        ("import no_such_module", "ModuleNotFoundError: No module named 'no_such_module'"),
        ("BAD = 2", "TypeError: is a int; must be a Number"),
        ("BAD = Number('one', 2)", "ValueError: the name one is in use"),
        ("BAD = Number('unit', 2)", "ValueError: the name unit is in use"),
        ("BAD = Number('two', 2, 'one')", "ValueError: the name one is in use"),
        ("BAD = Number('zero', 0)", "ValueError: the name zero is in use"),
        ("BAD = Number('two', -2)", "ValueError: value=-2: must be 0 or more"),
    ],
)
def test_an_entry_that_fails_is_left_out_with_one_warning(package: Install, source: str, problem: str) -> None:
    package(source, {"bad": "BAD"})
    numbers = table()
    with pytest.warns(PlugInWarning) as caught:
        assert dict(numbers) == {"one": OWN}
    assert [str(one.message) for one in caught] == [f"{GROUP}: bad of numbers-of-others is left out: {problem}"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(numbers) == 1


def test_other_entries_of_a_package_stay(package: Install) -> None:
    package("TWO = Number('two', 2)", {"missing": "MISSING", "two": "TWO", "again": "TWO"})
    numbers = table()
    with pytest.warns(PlugInWarning, match="missing of .* is left out: AttributeError|again of .* the name two is in use"):
        assert list(numbers) == ["one", "two"]


def test_a_package_may_use_the_table_while_it_is_imported(package: Install, monkeypatch: pytest.MonkeyPatch) -> None:
    numbers = table()
    monkeypatch.setattr(sys.modules[__name__], "NUMBERS", numbers, raising=False)
    package(f"from {__name__} import NUMBERS\nTWO = Number('two', 1 + NUMBERS['one'].value)", {"two": "TWO"})
    assert numbers["two"].value == 2
