"""Settings of the cameras of a scene."""

from __future__ import annotations

import dataclasses as dc
from typing import Annotated

from deodar.declarations import Recompile
from deodar.worlds._settings import From0, PeriodCount, WorldSettings


@dc.dataclass(frozen=True)
class MuJoCoCameras(WorldSettings):
    """What the cameras of a scene see, and how often.

    Attributes:
        camera_every: number of periods for which a picture of a camera is kept.
        pixel_noise: standard deviation of each channel of each pixel; values stay between 0 and 1.
        light: factor on the light that cameras see; it changes the value of colours, not hue or saturation.
        render: how cameras are computed: rays (everywhere the same, without textures and shadows), or egl
            (OpenGL by the driver of this machine, where it has EGL).
    """

    camera_every: PeriodCount = 4
    pixel_noise: From0 = 0.0
    light: From0 = 1.0
    render: Annotated[str, Recompile(choices=("rays", "egl"))] = "rays"


CAMERAS = MuJoCoCameras()
