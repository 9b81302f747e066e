"""Names for entries of the group `escape_explorer.layers`, which are instances of `Layer`."""

from engine.foundations.arrays import read_only as read_only
from engine.jobs.job import Job as Job
from engine.maps.map_jobs import map_job as map_job
from engine.maps.pixels import PixelAnalysis as PixelAnalysis
from plots.layers.layer import Code as Code
from plots.layers.layer import Count as Count
from plots.layers.layer import Layer as Layer
from plots.layers.layer import Over as Over
from plots.layers.layer import Pixels as Pixels
from plots.layers.layer import Stroke as Stroke
from plots.layers.layer import occurring_entries as occurring_entries
from plots.layers.picture import Legend as Legend
from plots.layers.picture import Picture as Picture
from plots.layers.picture import ShownMap as ShownMap
from plots.layers.value_scale import ValueScale as ValueScale
from plots.pictures.palette import CLEAR as CLEAR
from plots.pictures.palette import Entry as Entry
from plots.pictures.palette import Palette as Palette
from plots.pictures.setting import Setting as Setting
from plots.pictures.setting import Settings as Settings
