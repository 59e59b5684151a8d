"""Serve the wheel of the tests by the command `deodar serve`: ENDPOINT LOG CLOCK."""

from __future__ import annotations

import sys
from typing import Any

from deodar.cli import _options, main
from tests.deodar_robots.zenoh.wheel import Wheel

if __name__ == "__main__":
    endpoint, log, clock = sys.argv[1:]
    options: Any = _options
    options.world = lambda text: Wheel(log)
    raise SystemExit(main(["serve", "wheel:log", "--at", endpoint, "--name", "wheel", "--clock", clock]))
