"""Readings of infrared sensors among boxes, as pure functions of one copy."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.worlds.arena.contact import rays
from deodar.worlds.arena.vehicle import Infrared, ahead


def distances(
    sensors: Infrared, position: Array, heading: Array, boxes: Array, present: Array, reflection: Array
) -> Array:
    """Return the distance (sensors,) to the nearest box along one ray, m, divided by `reflection` for sensors
    whose readings depend on it.

    Rays end at ten times the largest distance of the table; readings are constant beyond the table.
    """
    dtype = boxes.dtype
    forward, leftward = jnp.asarray(sensors.forward, dtype), jnp.asarray(sensors.left, dtype)
    front = ahead(heading)
    side = jnp.stack([-front[1], front[0]])
    origins = position + forward[:, None] * front + leftward[:, None] * side
    looks = ahead(heading + jnp.asarray(sensors.angles, dtype)).T
    # an object that reflects twice as well as the table's surface is detected up to twice the range
    longest = 10 * sensors.distances[-1]
    lengths = jnp.minimum(rays(origins, looks, boxes, present, longest), longest)
    return lengths / reflection if sensors.reflects else lengths


def readings(sensors: Infrared, distance: Array, deviates: Array) -> Array:
    """Return the reading (sensors,) at distances, with noise from standard normal deviates; at least 0.

    Reading and noise are interpolated linearly between the entries of the table.
    """
    at = jnp.asarray(np.asarray(sensors.distances), distance.dtype)
    reading = jnp.interp(distance, at, jnp.asarray(np.asarray(sensors.readings), distance.dtype))
    share = jnp.interp(distance, at, jnp.asarray(np.asarray(sensors.noise), distance.dtype))
    return jnp.maximum(reading * (1 + share * deviates), 0.0)
