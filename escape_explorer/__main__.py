"""Run ``escape-explorer`` as ``python -m escape_explorer``."""

import sys

from cli.main import main

if __name__ == "__main__":
    sys.exit(main())
