"""Progress bars of long calls in terminals and notebooks."""

from __future__ import annotations

import functools
import inspect
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

# Shorter calls show no bar, in seconds.
_DELAY = 1.0
_FORMAT = "{desc}: {percentage:3.0f}% |{bar}| {elapsed}<{remaining}"
# Whether a bar is shown: calls within a call show none.
_shown = threading.Event()


def shows_progress[**P, T](label: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Decorator for functions with a parameter ``on_progress``, which is called with the share done, 0 to 1.

    Without it, and without ``on_frame``, calls of the main thread in a terminal or a notebook show a bar after a second. The
    environment variable ``TQDM_DISABLE=1`` turns all bars off.
    """

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        signature = inspect.signature(function)

        @functools.wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> T:
            given = signature.bind_partial(*args, **kwargs).arguments
            follows = any(given.get(name) is not None for name in ("on_progress", "on_frame"))
            if follows or _shown.is_set() or not _is_interactive():
                return function(*args, **kwargs)
            with _bar(label) as report:
                options: dict[str, Any] = {**kwargs, "on_progress": report}
                return function(*args, **options)

        return call

    return decorate


def _is_interactive() -> bool:
    """Whether a person waits for this call."""
    if threading.current_thread() is not threading.main_thread():
        return False
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())


@contextmanager
def _bar(label: str) -> Iterator[Callable[[float], None]]:
    with warnings.catch_warnings():
        # Without Jupyter's widgets a bar of text is shown, with a warning.
        warnings.simplefilter("ignore")
        from tqdm.autonotebook import tqdm

        bar = tqdm(total=1.0, desc=label, delay=_DELAY, leave=False, bar_format=_FORMAT)

    def report(share: float) -> None:
        bar.update(max(share - bar.n, 0.0))

    _shown.set()
    try:
        with bar:
            yield report
    finally:
        _shown.clear()
