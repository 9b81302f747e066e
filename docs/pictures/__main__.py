"""Make pictures: all, or those whose names begin with an argument. Run: python -m docs.pictures [drawings | gallery/sali | …]"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from docs.pictures import drawings, gallery, screenshots


def main(beginnings: Sequence[str]) -> None:
    """Make the pictures whose names, such as drawings/maps, begin with one of these."""
    for kind in (drawings, gallery, screenshots):
        kind.make([name for name in kind.PICTURES if not beginnings or name.startswith(tuple(beginnings))])


if __name__ == "__main__":
    main(sys.argv[1:])
