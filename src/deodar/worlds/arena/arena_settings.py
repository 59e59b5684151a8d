"""Numbers of an arena that apply to all of its trials."""

from __future__ import annotations

import dataclasses as dc

from deodar.errors import WorldError, did_you_mean
from deodar.parameters import show
from deodar.worlds._settings import number, periods

CONTACTS = ("slide", "stick")
PICTURE_NOISES = ("pixel_noise", "hue_noise", "outliers", "clutter")
SHARES = ("outliers", "clutter")


@dc.dataclass(frozen=True)
class ArenaPhysics:
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

    period: float = 64.0
    contact: str = "slide"
    reflection: float = 0.6
    place_every: int = 1
    camera_every: int = 1

    def __post_init__(self) -> None:
        if self.contact not in CONTACTS:
            raise WorldError(
                f"contact is {show(self.contact)}", fix=did_you_mean(str(self.contact), CONTACTS)
            )
        for name in ("period", "reflection"):
            object.__setattr__(self, name, number(name, getattr(self, name), above=0.0))
        for name in ("place_every", "camera_every"):
            object.__setattr__(self, name, periods(name, getattr(self, name)))


@dc.dataclass(frozen=True)
class ArenaNoise:
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

    place_noise: float = 0.0
    infrared_noise: float = 1.0
    slip: float = 0.0
    encoder_noise: float = 0.0
    pixel_noise: float = 0.0
    hue_noise: float = 0.0
    outliers: float = 0.0
    clutter: float = 0.0

    def __post_init__(self) -> None:
        for name, share in dc.asdict(self).items():
            object.__setattr__(self, name, number(name, share))
            if name in SHARES and getattr(self, name) > 1:
                raise WorldError(f"{name} is {show(share)}; expected a share, from 0 to 1")

    @property
    def in_pictures(self) -> tuple[str, ...]:
        """The names of the noises of the camera that are not 0."""
        return tuple(name for name in PICTURE_NOISES if getattr(self, name) > 0)


PHYSICS, NOISE = ArenaPhysics(), ArenaNoise()
