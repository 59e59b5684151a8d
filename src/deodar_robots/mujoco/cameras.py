"""Settings of the cameras of a scene."""

from __future__ import annotations

import dataclasses as dc

from deodar.errors import WorldError, did_you_mean
from deodar.parameters import show
from deodar.worlds._settings import number, periods

RENDERS = ("rays", "egl")


@dc.dataclass(frozen=True)
class MuJoCoCameras:
    """What the cameras of a scene see, and how often.

    Attributes:
        camera_every: number of periods for which a picture of a camera is kept.
        pixel_noise: standard deviation of each channel of each pixel; values stay between 0 and 1.
        light: factor on the light that cameras see; it changes the value of colours, not hue or saturation.
        render: how cameras are computed: rays (everywhere the same, without textures and shadows), or egl
            (OpenGL by the driver of this machine, where it has EGL).
    """

    camera_every: int = 4
    pixel_noise: float = 0.0
    light: float = 1.0
    render: str = "rays"

    def __post_init__(self) -> None:
        object.__setattr__(self, "camera_every", periods("camera_every", self.camera_every))
        for name in ("pixel_noise", "light"):
            object.__setattr__(self, name, number(name, getattr(self, name)))
        if self.render not in RENDERS:
            raise WorldError(
                f"render is {show(self.render)}; expected rays or egl",
                fix=did_you_mean(str(self.render), RENDERS),
            )


CAMERAS = MuJoCoCameras()
