"""The vehicles that come with deodar, by name."""

from __future__ import annotations

from deodar.errors import WorldError, did_you_mean
from deodar.parameters import show
from deodar.worlds.arena.epuck import EPUCK
from deodar.worlds.arena.khepera import KHEPERA
from deodar.worlds.arena.vehicle import Vehicle

VEHICLES = {vehicle.name: vehicle for vehicle in (EPUCK, KHEPERA)}


def vehicle_of(vehicle: str | Vehicle) -> Vehicle:
    """Return the vehicle of a name, or the one that was given.

    Raises:
        WorldError: there is no vehicle of this name.
    """
    if isinstance(vehicle, Vehicle):
        return vehicle
    if vehicle not in VEHICLES:
        raise WorldError(f"there is no vehicle {show(vehicle)}", fix=did_you_mean(str(vehicle), VEHICLES))
    return VEHICLES[vehicle]
