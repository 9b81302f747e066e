"""Names for entries of the group `escape_explorer.systems`, which are instances of `CatalogueEntry`."""

from engine.systems.catalogue.entry import CatalogueEntry as CatalogueEntry
from engine.systems.catalogue.entry import EnergyRange as EnergyRange
