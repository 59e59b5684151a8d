"""Turn the wheel of the tests at 2 rad/s by a model that is paced to the wall clock: ENDPOINT."""

from __future__ import annotations

import sys
import time

import deodar as dd
from deodar.errors import WorldError
from deodar_robots.zenoh.zenoh import Zenoh


def say(text: str) -> None:
    """Print a line at once."""
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    model = dd.Model("turning", dt=10)
    model.add(dd.Sensor("see", sensor="angle"))
    model.add(dd.Boost("go", amplitude=2.0)) >> model.add(dd.Motor("turn", motor="speed"))
    session = dd.Session(model, world=Zenoh(at=sys.argv[1]))
    session.run(100)
    say("ready")
    try:
        session.run_live(60_000)
    except WorldError as error:
        say(f"{time.monotonic():.6f} {error}")
