"""The studies as entries of one table, which the page, links, files, figures and the command line use."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from engine.foundations.plug_ins import Entries, Group
from plots.studies.against import AGAINST
from plots.studies.family import FAMILY_STUDY
from plots.studies.nine_energies import NINE_ENERGIES
from plots.studies.periodic import PERIODIC_STUDY
from plots.studies.plate import PLATE_STUDY
from plots.studies.section import SECTION_STUDY
from plots.studies.study import Study

_ENTRIES: tuple[Study[Any], ...] = (SECTION_STUDY, PERIODIC_STUDY, NINE_ENERGIES, PLATE_STUDY, AGAINST, FAMILY_STUDY)

STUDIES: Mapping[str, Study[Any]] = Entries(Group.STUDIES, Study, _ENTRIES)
"""The studies by name, in the order of their tabs, with those of other packages."""


def studies_by_tab() -> dict[str, list[str]]:
    """Return the names of the studies in the tab of each study that has one."""
    return {
        name: [name, *(each for each, other in STUDIES.items() if other.tab == name)] for name in STUDIES if not STUDIES[name].tab
    }
