"""The command `python -m deodar`, equal to `deodar`."""

import sys

from deodar.cli import main

sys.exit(main())
