"""Tables of entries, to which other installed packages add theirs through entry points."""

from __future__ import annotations

import contextlib
import threading
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import StrEnum
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Protocol

from engine.foundations.names import unknown_name


class Group(StrEnum):
    """The groups of entry points, one for each table."""

    SYSTEMS = "escape_explorer.systems"
    MEASURES = "escape_explorer.measures"
    LAYERS = "escape_explorer.layers"
    STUDIES = "escape_explorer.studies"


class PlugInWarning(RuntimeWarning):
    """An entry of another package cannot be used and is left out."""


class Named(Protocol):
    """An entry of a table."""

    @property
    def name(self) -> str:
        """The name in the table."""


def _own_name(entry: Named) -> Iterable[str]:
    return (entry.name,)


def _accept(entry: Any) -> None:
    """Accept any entry."""


class Entries[Entry: Named](Mapping[str, Entry]):
    """The entries of a table by name: those of this program, then those of other packages.

    Other packages are imported when an entry is first looked up or listed. An entry that cannot be imported, is not valid or has
    a name in use is left out, with a warning that names it.

    Parameters
    ----------
    group
        The group of the entry points, each of which refers to an entry. Its value is their name in metadata.
    kind
        The class of the entries.
    own
        The entries of this program.
    names
        Returns all names that an entry defines and no other entry may define; by default its name.
    reserved
        Further names that no entry of another package may define.
    check
        Raises an error if an entry of another package is not valid.
    """

    def __init__(
        self,
        group: str,
        kind: type[Entry],
        own: Iterable[Entry],
        *,
        names: Callable[[Entry], Iterable[str]] = _own_name,
        reserved: Iterable[str] = (),
        check: Callable[[Entry], object] = _accept,
    ) -> None:
        self._group, self._kind, self._names, self._check = group, kind, names, check
        self._entries = {entry.name: entry for entry in own}
        self._taken = {*reserved, *(name for entry in self._entries.values() for name in names(entry))}
        self._is_loaded = False
        self._lock = threading.RLock()

    def __getitem__(self, name: str) -> Entry:
        """Return the entry of a name; for an unknown name, raise an `UnknownNameError` that suggests similar names."""
        entries = self._load()
        if name not in entries:
            raise unknown_name(self._kind.__name__.lower(), name, entries)
        return entries[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._load())

    def __len__(self) -> int:
        return len(self._load())

    def _load(self) -> Mapping[str, Entry]:
        with self._lock:
            if not self._is_loaded:
                # Now, because a package may use the table while it is imported.
                self._is_loaded = True
                for point in entry_points(group=self._group):
                    self._add(point)
        return self._entries

    def _add(self, point: EntryPoint) -> None:
        """Add the entry of an entry point, or warn that it is left out."""
        try:
            entry = self._checked(point.load())
        except Exception as error:
            package = "an unknown package" if point.dist is None else point.dist.name
            message = f"{point.group}: {point.name} of {package} is left out: {type(error).__name__}: {error}"
            warnings.warn(message, PlugInWarning, stacklevel=2)
            return
        self._entries[entry.name] = entry
        self._taken.update(self._names(entry))

    def _checked(self, entry: Any) -> Entry:
        if not isinstance(entry, self._kind):
            raise TypeError(f"is a {type(entry).__name__}; must be a {self._kind.__name__}")
        if shared := self._taken.intersection(self._names(entry)):
            raise ValueError(f"the name {', '.join(sorted(shared))} is in use")
        self._check(entry)
        return entry


def import_plug_ins() -> None:
    """Import the modules of all entry points, which define classes of results. Those that fail are skipped."""
    for group in Group:
        for point in entry_points(group=group):
            with contextlib.suppress(Exception):
                point.load()
