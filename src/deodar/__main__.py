"""`python -m deodar` is `deodar`."""

import sys

from deodar.cli import main

sys.exit(main())
