"""A mapping from names to values, whose error for an unknown name suggests similar names."""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Callable, Collection, Iterator, Mapping

from engine.foundations.validation import short_repr

# Smallest similarity, from 0 to 1, of a name that an error suggests.
_SMALLEST_SIMILARITY = 0.6


class UnknownNameError(KeyError, ValueError):
    """A name is not in a mapping. The message is one sentence."""

    def __str__(self) -> str:
        return str(self.args[0])


class ByName[Value](Mapping[str, Value]):
    """Values by name.

    Parameters
    ----------
    kind
        The word for a value in errors, such as "potential".
    names
        The names, also those that are added later.
    make
        Function that returns the value of a name. It is called at each look-up.
    title_of
        Function that returns the title of a name. For an unknown name that resembles a title, the error suggests the name with
        this title. By default titles are the names.
    """

    def __init__(
        self, kind: str, names: Collection[str], make: Callable[[str], Value], title_of: Callable[[str], str] = str
    ) -> None:
        self._kind, self._names, self._make, self._title_of = kind, names, make, title_of

    def __getitem__(self, name: str) -> Value:
        """Return the value of a name; for an unknown name, raise an `UnknownNameError` that suggests similar names."""
        if name in self:
            return self._make(name)
        raise unknown_name(self._kind, name, self._names, self._title_of)

    def __contains__(self, name: object) -> bool:
        # Users may pass any object.
        return isinstance(name, str) and name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<{self._kind}s: {', '.join(self._names)}>"


def unknown_name(kind: str, name: object, names: Collection[str], title_of: Callable[[str], str] = str) -> UnknownNameError:
    """Return the error for an unknown name, which suggests similar names; the arguments are those of `ByName`."""
    similar_names = _find_similar(str(name), names, title_of)
    question = f"did you mean {' or '.join(map(repr, similar_names))}? The" if similar_names else "the"
    return UnknownNameError(f"{kind} {short_repr(name)}: {question} names are {', '.join(names)}")


def _find_similar(name: str, names: Collection[str], title_of: Callable[[str], str]) -> list[str]:
    """Return up to three names with similar spelling, the most similar first."""
    # Names by the plain spelling of the name and of its title.
    spellings = {_plain_spelling(text): known for known in names for text in (known, title_of(known))}
    matches = difflib.get_close_matches(_plain_spelling(name), spellings, n=3, cutoff=_SMALLEST_SIMILARITY)
    return list(dict.fromkeys(spellings[match] for match in matches))


def _plain_spelling(name: str) -> str:
    """Return the letters and digits of a name in lower case, without accents."""
    decomposed = unicodedata.normalize("NFKD", name.casefold())
    return "".join(letter for letter in decomposed if letter.isalnum())
