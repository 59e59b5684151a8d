"""The vehicles that come with deodar, by name."""

from __future__ import annotations

from deodar.errors import WorldError, did_you_mean
from deodar.parameters import show
from deodar.worlds.arena.epuck import EPUCK
from deodar.worlds.arena.khepera import KHEPERA
from deodar.worlds.arena.vehicle import Vehicle

VEHICLES = {vehicle.name: vehicle for vehicle in (EPUCK, KHEPERA)}


def vehicle_of(given: str | Vehicle) -> Vehicle:
    """Return the vehicle of a name, or the one that was given.

    Raises:
        WorldError: there is no vehicle of this name.
    """
    if isinstance(given, Vehicle):
        return given
    if given not in VEHICLES:
        raise WorldError(f"there is no vehicle {show(given)}", fix=did_you_mean(str(given), VEHICLES))
    return VEHICLES[given]
