"""Names for entries of the group `escape_explorer.studies`, which are instances of `Study`."""

from engine.foundations.result import RecordedResult as RecordedResult
from engine.jobs.job import Job as Job
from engine.jobs.job import Queue as Queue
from plots.pictures.charts import Chart as Chart
from plots.pictures.charts import Frame as Frame
from plots.pictures.charts import Series as Series
from plots.pictures.charts import Shape as Shape
from plots.pictures.palette import Palette as Palette
from plots.pictures.setting import Setting as Setting
from plots.pictures.setting import Settings as Settings
from plots.studies.axes import ENERGY as ENERGY
from plots.studies.axes import changes_at as changes_at
from plots.studies.axes import energy_and_parameters as energy_and_parameters
from plots.studies.axes import parameter_axis as parameter_axis
from plots.studies.axes import spaced_values as spaced_values
from plots.studies.study import Study as Study
from plots.studies.study import Subject as Subject
