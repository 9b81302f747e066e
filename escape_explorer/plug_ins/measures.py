"""Names for entries of the group `escape_explorer.measures`, which are instances of `Measure`."""

from engine.foundations.result import RecordedResult as RecordedResult
from engine.measures.basins.starts import Starts as Starts
from engine.measures.basins.starts import read_starts as read_starts
from engine.measures.basins.starts import wilson_interval as wilson_interval
from engine.measures.measure import Bars as Bars
from engine.measures.measure import Curve as Curve
from engine.measures.measure import Measure as Measure
from engine.measures.measure import Quantity as Quantity
from engine.measures.measured_map import MeasuredMap as MeasuredMap
