"""Any environment gives settings within their limits, or an error that names the variable."""

from __future__ import annotations

import math
from dataclasses import asdict, fields

from hypothesis import given
from hypothesis import strategies as st

from app.runtime.settings import Settings, read_settings, variable_name
from tests.fuzz.hostile import floats, result_or_error, texts

VARIABLES = [variable_name(setting.name) for setting in fields(Settings)]
values = (
    texts
    | floats.map(repr)
    | st.integers().map(str)
    | st.sampled_from(["1e5", "json", "none", "https://a.example", "12 ", "0x10"])
)


@given(st.dictionaries(st.sampled_from([*VARIABLES, "ESCAPE_EXPLORER_CACHE", "PATH"]), values, max_size=4))
def test_any_environment_gives_legal_settings_or_an_error(environment: dict[str, str]) -> None:
    settings = result_or_error(lambda: read_settings(environment), VARIABLES)
    if settings is None:
        return
    numbers = {name: value for name, value in asdict(settings).items() if isinstance(value, int | float)}
    assert all(math.isfinite(value) and value >= 0 for value in numbers.values())
    assert min(numbers[name] for name in ("threads", "most_sessions", "most_orbits")) >= 1
    assert not any(set(origin) & set(";,'\"\r\n ") for origin in settings.frame_ancestors)
