"""The text of a pixel has words for every code of the layers."""

from __future__ import annotations

from bokeh.models import ColumnDataSource, CustomJSHover, Range1d

from app.views.maps.hover import CHARACTER, TRUST, pixel_hover
from engine import Evidence, Regularity, Trust


def test_every_code_of_a_layer_has_words_in_its_order() -> None:
    hover = pixel_hover(ColumnDataSource(), ColumnDataSource(), ColumnDataSource(), Range1d(), Range1d())
    formatter = hover.formatters["@crossing_class"]
    assert isinstance(formatter, CustomJSHover)
    assert formatter.args["words"]["trusts"] == [TRUST.get(code, "") for code in sorted(Trust)]
    assert formatter.args["words"]["characters"] == [CHARACTER.get(code, "") for code in sorted(Regularity)]
    assert len(formatter.args["words"]["evidence"]) == len(Evidence)
    assert set(TRUST) == set(Trust) - {Trust.NOT_APPLICABLE}
    assert set(CHARACTER) == set(Regularity) - {Regularity.NOT_APPLICABLE}
