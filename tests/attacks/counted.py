"""`deodar studio` that counts its objects: on SIGUSR1 it writes the numbers to the file that the
environment variable COUNTS names.
"""

from __future__ import annotations

import asyncio
import gc
import json
import os
import signal
import sys
import threading
from pathlib import Path
from types import FrameType

from deodar import cli
from deodar.session.session import Session
from deodar_studio.web.connection import PageConnection


def count(number: int, frame: FrameType | None) -> None:
    """Write the numbers; the file is renamed, so that it is never read half written."""
    gc.collect()
    objects = gc.get_objects()
    kinds = [type(o) for o in objects]
    found = {
        "objects": len(objects),
        "tasks": len(asyncio.all_tasks()),
        "threads": threading.active_count(),
        "sessions": kinds.count(Session),
        "connections": kinds.count(PageConnection),
    }
    place = Path(os.environ["COUNTS"])
    place.with_suffix(".new").write_text(json.dumps(found))
    place.with_suffix(".new").rename(place)


if __name__ == "__main__":
    signal.signal(signal.SIGUSR1, count)
    sys.exit(cli.main())
