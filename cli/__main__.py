"""``python -m cli`` is ``escape-explorer``."""

import sys

from cli.main import main

sys.exit(main())
