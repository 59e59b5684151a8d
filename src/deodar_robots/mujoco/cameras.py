"""What the cameras of a scene see: their settings, pictures by rays or by OpenGL, and visible shares."""

from __future__ import annotations

import ctypes
import dataclasses as dc
import functools
import math
from typing import Annotated, Any

import numpy as np

from deodar.declarations import Recompile
from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.worlds._settings import From0, PeriodCount, WorldSettings
from deodar_robots.mujoco.scene_file import simulator


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


CHANNELS = 3
AMBIENT = 0.4
"""Share of its colour that a surface shows where no light falls on it; the rest is diffuse reflection."""

VISIBLE = np.array([1, 1, 1, 0, 0, 0], np.uint8)
"""Groups of geoms that a camera sees: those that MuJoCo's own viewer shows."""

BACKGROUND = 0.1
"""Grey of rays that meet nothing."""

FAR = 1e10


def require_picture(sensor: str, axes: Axes) -> None:
    """Raise WorldError unless the axes are columns, rows and three channels."""
    if len(axes) != 3 or axes[2].samples != CHANNELS:
        raise WorldError(
            f"a picture has columns, rows and three channels, not {len(axes)} axes", where=sensor
        )


@functools.lru_cache(maxsize=16)
def directions(columns: int, rows: int, opening: float) -> np.ndarray:
    """Return the unit vector of the ray through each pixel, in the frame of a camera that looks along -z.

    The vertical opening angle (degrees) covers all rows; pixels are squares, so the columns decide the
    horizontal one. Shape (columns * rows, 3): the first column from above, then the next.
    """
    half = math.tan(math.radians(opening) / 2)
    across = (np.arange(columns) + 0.5 - columns / 2) * 2 * half / rows
    down = (np.arange(rows) + 0.5 - rows / 2) * 2 * half / rows
    x, y = np.meshgrid(across, down, indexing="ij")
    rays = np.stack([x, -y, -np.ones_like(x)], axis=-1).reshape(-1, 3)
    return rays / np.linalg.norm(rays, axis=1, keepdims=True)


def shades(model: Any) -> np.ndarray:
    """Return red, green and blue of each geom: its own colour, or that of its material.

    A geom has the colour of its material unless it states one; textures are not shown.
    """
    own = np.array(model.geom_rgba[:, :3], float)
    plain = np.all(np.asarray(model.geom_rgba) == 0.5, axis=1) | np.all(
        np.isclose(model.geom_rgba, [0.5, 0.5, 0.5, 1.0]), axis=1
    )
    material = np.asarray(model.geom_matid)
    use = plain & (material >= 0)
    if use.any():
        own[use] = np.asarray(model.mat_rgba)[material[use], :3]
    return own


def sun(model: Any) -> np.ndarray:
    """Return the direction from which light falls: that of the first light, else from above."""
    if model.nlight == 0:
        return np.array([0.0, 0.0, 1.0])
    found = -np.asarray(model.light_dir[0], float)
    return found / np.linalg.norm(found)


def picture(
    model: Any, data: Any, camera: int, size: tuple[int, int], colors: np.ndarray, light: float
) -> np.ndarray:
    """Return the colours that a camera sees, (columns, rows, 3), from 0 to 1.

    A surface of colour c with the normal n shows light * c * (a + (1 - a) * max(0, n . l)), with the share a
    of ambient light and the direction l of the light. `light` changes value, not hue or saturation.
    """
    frame = np.asarray(data.cam_xmat[camera]).reshape(3, 3)
    rays = directions(*size, float(model.cam_fovy[camera])) @ frame.T
    count = len(rays)
    geom, distance, normal = np.full(count, -1, np.int32), np.empty(count), np.zeros(3 * count)
    simulator().mj_multiRay(
        model,
        data,
        np.asarray(data.cam_xpos[camera]).reshape(3, 1),
        rays.reshape(-1, 1),
        VISIBLE,
        1,
        -1,
        geom,
        distance,
        normal,
        count,
        FAR,
    )
    lit = AMBIENT + (1 - AMBIENT) * np.clip(normal.reshape(-1, 3) @ sun(model), 0.0, None)
    seen = np.where((geom >= 0)[:, None], colors[geom] * lit[:, None], BACKGROUND) * light
    return np.clip(seen, 0.0, 1.0).reshape(*size, CHANNELS).astype(np.float32)


POINTS = 200
"""Points on the top of an object to which rays are cast."""

LIFT = 1e-4
"""Height of these points above the top, m, so that the rays end outside of the object."""


def visible(model: Any, data: Any, camera: int, body: str, radius: float, height: float) -> float:
    """Return the share of the top of a body that a camera sees, 0 to 1.

    The top is a disc around the vertical axis of the body; points cover it evenly, in a golden spiral.
    """
    k = np.arange(POINTS)
    away, turn = radius * np.sqrt((k + 0.5) / POINTS), k * math.pi * (3 - math.sqrt(5))
    own = np.stack([away * np.cos(turn), away * np.sin(turn), np.full(POINTS, height / 2 + LIFT)], axis=1)
    place = data.body(body)
    tops = own @ np.asarray(place.xmat).reshape(3, 3).T + place.xpos
    eye = np.asarray(data.camera(camera).xpos)
    rays, lengths = tops - eye, np.linalg.norm(tops - eye, axis=1)
    geom, distance = np.full(POINTS, -1, np.int32), np.empty(POINTS)
    simulator().mj_multiRay(
        model,
        data,
        eye.reshape(3, 1),
        (rays / lengths[:, None]).reshape(-1, 1),
        VISIBLE,
        1,
        -1,
        geom,
        distance,
        None,
        POINTS,
        FAR,
    )
    return float(np.mean((geom < 0) | (distance >= lengths - 1e-9)))


LIBRARY = "libEGL.so.1"

# of the headers of EGL
DEVICE_PLATFORM, OPENGL, NONE = 0x313F, 0x30A2, 0x3038
WANTED = (
    *(0x3024, 8, 0x3023, 8, 0x3022, 8),  # bits of red, green and blue
    *(0x3025, 24),  # of depth
    *(0x3033, 1),  # surfaces outside of a window
    *(0x3040, 8),  # OpenGL
    NONE,
)
MOST_DEVICES = 16

MOST_GEOMS = 10_000
"""Largest number of geoms in a picture, with those that MuJoCo adds."""


class Context:
    """A context of OpenGL without a display, on the first device that has one.

    Raises:
        WorldError: this machine has no EGL, or no device of it.
    """

    def __init__(self) -> None:
        try:
            self._egl = egl = ctypes.CDLL(LIBRARY)
        except OSError:
            raise _absent(f"there is no {LIBRARY}") from None
        pointer, integer = ctypes.c_void_p, ctypes.c_int
        egl.eglGetProcAddress.restype, egl.eglGetProcAddress.argtypes = pointer, [ctypes.c_char_p]
        egl.eglInitialize.argtypes = [pointer] * 3
        egl.eglChooseConfig.argtypes = [pointer, pointer, pointer, integer, pointer]
        egl.eglCreateContext.restype, egl.eglCreateContext.argtypes = pointer, [pointer] * 4
        egl.eglMakeCurrent.argtypes = [pointer] * 4
        query = self._extension(b"eglQueryDevicesEXT", integer, integer, pointer, pointer)
        display_of = self._extension(b"eglGetPlatformDisplayEXT", pointer, integer, pointer, pointer)
        count, devices = integer(), (pointer * MOST_DEVICES)()
        query(MOST_DEVICES, devices, ctypes.byref(count))
        self._display = next(
            (
                display
                for device in devices[: count.value]
                if (display := display_of(DEVICE_PLATFORM, device, None))
                and egl.eglInitialize(display, None, None)
            ),
            None,
        )
        if self._display is None:
            raise _absent("EGL has no device here")
        config, found = pointer(), integer()
        wanted = (integer * len(WANTED))(*WANTED)
        egl.eglChooseConfig(self._display, wanted, ctypes.byref(config), 1, ctypes.byref(found))
        egl.eglBindAPI(OPENGL)
        self._context = egl.eglCreateContext(self._display, config, None, (integer * 1)(NONE))
        if not found.value or not self._context:
            raise _absent("its EGL has no OpenGL")

    def use(self) -> None:
        """Make the context that of the calling thread."""
        if not self._egl.eglMakeCurrent(self._display, None, None, self._context):
            raise WorldError("another thread draws the pictures of a camera", fix='Use render="rays"')

    def release(self) -> None:
        """Leave the context to another thread."""
        self._egl.eglMakeCurrent(self._display, None, None, None)

    def _extension(self, name: bytes, result: Any, *arguments: Any) -> Any:
        address = self._egl.eglGetProcAddress(name)
        if not address:
            raise _absent(f"its EGL has no {name.decode()}")
        return ctypes.CFUNCTYPE(result, *arguments)(address)


class Renderer:
    """Draws the cameras of a compiled scene."""

    def __init__(self, model: Any, size: tuple[int, int]) -> None:
        mujoco = simulator()
        self.size, self._model = size, model
        context().use()
        try:
            shown = model.vis.global_
            shown.offwidth, shown.offheight = max(shown.offwidth, size[0]), max(shown.offheight, size[1])
            self._drawn = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._drawn)
        finally:
            context().release()
        self._scene = mujoco.MjvScene(model, maxgeom=MOST_GEOMS)
        self._options, self._camera = mujoco.MjvOption(), mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED

    def picture(self, data: Any, camera: int, light: float) -> np.ndarray:
        """Return the colours that a camera sees, (columns, rows, 3), from 0 to 1, times `light`."""
        mujoco = simulator()
        columns, rows = self.size
        self._camera.fixedcamid = camera
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(self._model, data, self._options, None, self._camera, everything, self._scene)
        area, pixels = mujoco.MjrRect(0, 0, columns, rows), np.empty((rows, columns, CHANNELS), np.uint8)
        context().use()
        try:
            mujoco.mjr_render(area, self._scene, self._drawn)
            mujoco.mjr_readPixels(pixels, None, area, self._drawn)
        finally:
            context().release()
        seen = pixels[::-1].transpose(1, 0, 2).astype(np.float32) / 255 * np.float32(light)
        return np.clip(seen, 0.0, 1.0)


@functools.cache
def context() -> Context:
    """Return the context of this process."""
    return Context()


def _absent(why: str) -> WorldError:
    return WorldError(
        f"cameras cannot be drawn by EGL: {why}",
        fix='Use render="rays", which needs nothing, or install a driver with EGL, such as libegl1 of Mesa',
    )
