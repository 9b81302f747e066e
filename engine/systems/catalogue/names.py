"""A mapping of names that answers a wrong one with the names most like it."""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping

from engine.foundations.validation import short_repr

_LEAST_LIKENESS = 0.6


class UnknownNameError(KeyError, ValueError):
    """A name that is not in a mapping; the message is one sentence."""

    def __str__(self) -> str:
        return str(self.args[0])


class ByName[Value](Mapping[str, Value]):
    """Values by name.

    Parameters
    ----------
    kind
        What the names are names of, for errors.
    names
        The names.
    make
        The value of a name, called whenever it is looked up.
    titles
        Other names, by name, under which a value may be looked for; a wrong name that is like one of them is told the name.
    """

    def __init__(
        self, kind: str, names: Iterable[str], make: Callable[[str], Value], titles: Mapping[str, str] | None = None
    ) -> None:
        self._kind, self._names, self._make, self._titles = kind, tuple(names), make, dict(titles or {})

    def __getitem__(self, name: str) -> Value:
        """The value of a name; `UnknownNameError`, a KeyError and a ValueError, names those like it."""
        given: object = name
        if isinstance(given, str) and given in self._names:
            return self._make(given)
        near = self._like(str(name))
        meant = f"did you mean {' or '.join(map(repr, near))}? The" if near else "the"
        raise UnknownNameError(f"{self._kind} {short_repr(name)}: {meant} names are {', '.join(self._names)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<{self._kind}s: {', '.join(self._names)}>"

    def _like(self, name: str) -> list[str]:
        """Up to three names that are written like this one, the most similar first."""
        spelled = {_plain(other): known for known in self._names for other in (known, self._titles.get(known, known))}
        found = difflib.get_close_matches(_plain(name), spelled, n=3, cutoff=_LEAST_LIKENESS)
        return list(dict.fromkeys(spelled[each] for each in found))


def _plain(name: str) -> str:
    """Small letters and digits without accents."""
    decomposed = unicodedata.normalize("NFKD", name.casefold())
    return "".join(letter for letter in decomposed if letter.isalnum())
