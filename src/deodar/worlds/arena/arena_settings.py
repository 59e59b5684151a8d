"""Numbers of an arena that apply to all of its trials."""

from __future__ import annotations

import dataclasses as dc
from typing import Annotated

from deodar.declarations import Recompile
from deodar.worlds._settings import From0, PeriodCount, PositiveNumber, Share, WorldSettings

PICTURE_NOISES = ("pixel_noise", "hue_noise", "outliers", "clutter")


@dc.dataclass(frozen=True)
class ArenaPhysics(WorldSettings):
    """Time and surfaces of an arena.

    Attributes:
        period: ms between two exchanges with the model.
        contact: `slide` along what is touched, or `stick` to it.
        reflection: infrared reflectance of objects: an e-puck reads an object as if its distance were divided
            by it; a Khepera, whose readings are distances, does not depend on it. 0.6 is a fit: with 1 the
            published planner stops at the gaps of 10 cm of its large maze, which it passed.
        place_every: number of periods for which a reading of the place is kept.
        camera_every: number of periods for which a picture of the camera is kept.
    """

    period: PositiveNumber = 64.0
    contact: Annotated[str, Recompile(choices=("slide", "stick"))] = "slide"
    reflection: PositiveNumber = 0.6
    place_every: PeriodCount = 1
    camera_every: PeriodCount = 1


@dc.dataclass(frozen=True)
class ArenaNoise(WorldSettings):
    """Noise of the sensors and wheels of a vehicle in an arena.

    Attributes:
        place_noise: standard deviation of the place sensor, in the unit of the arena.
        infrared_noise: factor on the noise of the infrared sensors; 0 removes it.
        slip: standard deviation of the distance that a wheel rolls in a period, as a share of that distance.
        encoder_noise: standard deviation of an encoder's count in a period, as a share of that count.
        pixel_noise: standard deviation of each channel of each pixel of the camera; values stay between 0
            and 1.
        hue_noise: standard deviation of the hue of each pixel, degrees.
        outliers: share of the pixels that show a random saturated colour.
        clutter: share of the rows that strips of random colours cover where the camera sees no object, but
            the floor, the walls of the border or what is above them. A strip is 1/20 of the width; its colour
            and its rows are drawn once in each trial.
    """

    place_noise: From0 = 0.0
    infrared_noise: From0 = 1.0
    slip: From0 = 0.0
    encoder_noise: From0 = 0.0
    pixel_noise: From0 = 0.0
    hue_noise: From0 = 0.0
    outliers: Share = 0.0
    clutter: Share = 0.0

    @property
    def in_pictures(self) -> tuple[str, ...]:
        """The names of the noises of the camera that are not 0."""
        return tuple(name for name in PICTURE_NOISES if getattr(self, name) > 0)


PHYSICS, NOISE = ArenaPhysics(), ArenaNoise()
